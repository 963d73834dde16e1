#pragma once

#include <cstddef>
#include <mutex>
#include <vector>

#include "local_trend.hpp"
#include "slideway/effects/channel.hpp"

namespace slideway {

/// What a log says of the quantity that it measured: values that do not belong to it are left out,
/// runs of one value of a coarse resolution count as one reading in their middle, and the white
/// noise is smoothed away (LocalTrend). Where it jumps between two readings, when is not known: at
/// any time between them alike, which leaves a straight line with the error of a Brownian bridge
/// that is as wide as the jump. In the place of the log the quantity makes a Berkson error:
/// it is independent of what is known and leaves the gain without bias (Carroll et al. 2006,
/// Measurement Error in Nonlinear Models, section 2.2.3).
class MeasuredLog {
 public:
  explicit MeasuredLog(const Channel& log);

  /// The mean, at places of the log and where they are few between them.
  [[nodiscard]] const Channel& quantity() const { return quantity_; }

  /// The error of quantity(): independent parts of it, each one standard deviation.
  [[nodiscard]] const std::vector<Channel>& errors() const;

 private:
  void add_draws() const;
  /// Of a jump: that it is sooner or later, which moves its straight line, and the sines of the
  /// bridge (Karhunen-Loeve) but the first, which is that for the most part.
  void add_times(const LocalTrend::Jump& jump) const;

  Channel quantity_;
  LocalTrend trend_;
  std::vector<double> readings_;  // at the places of quantity_; NaN: none there
  mutable std::once_flag drawn_;
  mutable std::vector<Channel> errors_;
};

}  // namespace slideway
