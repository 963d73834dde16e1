#pragma once

#include <utility>
#include <vector>

#include "refine.hpp"
#include "slideway/identify/fit.hpp"

namespace slideway {

/// What a model leaves of the samples themselves. The low band folds a line faster than its values
/// can show, feed marks above all, to another rate. A line that only the low band has is none of
/// the face.
class SampleResiduals {
 public:
  SampleResiduals(const Model& model, const Solution& fit);

  /// Whether the square of the residual, a sum over all profiles in which the effect shows lines,
  /// falls with the effect as the low band has it; so for feed marks. True for any other effect
  /// without lines, for lines of fewer cycles than the model has amplitudes, which follow them, and
  /// where the low band is the samples.
  [[nodiscard]] bool have(const Refined& effect) const;

  struct Trace {
    const Profile* profile;
    const LowBand* low_band;
    std::vector<std::pair<Eigen::Index, Eigen::Index>> left_out;  // first sample, how many
    Eigen::MatrixXd level;     // orthonormal: offset and tilt of the trace, 0 where left out
    Eigen::VectorXd residual;  // levelled, 0 where left out

    explicit Trace(const Observation& observation);
    [[nodiscard]] Eigen::VectorXd levelled(Eigen::VectorXd signal) const;
  };
  /// Of the fitted profiles whose low band is not the samples.
  [[nodiscard]] const std::vector<Trace>& traces() const { return traces_; }

 private:
  const Model& model_;
  std::vector<Trace> traces_;
};

}  // namespace slideway
