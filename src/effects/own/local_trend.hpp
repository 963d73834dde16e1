#pragma once

#include <span>
#include <vector>

#include "slideway/base/random.hpp"

namespace slideway {

/// A quantity whose level and slope are random walks in continuous time, read with white noise: the
/// local linear trend (Harvey 1989, Forecasting, structural time series models and the Kalman
/// filter, sections 2.3.2 and 9.2). Without a walk of the level its mean is the cubic smoothing
/// spline. Beside the walks the level may jump, as where a valve opens, and the slope, as where a
/// load comes on that heats.
struct LocalTrend {
  /// Between two readings: the level (the slope) after it says nothing of that before it.
  struct Jump {
    double from = 0.0, to = 0.0;
  };

  double noise = 0.0;    // standard deviation of a reading
  double spacing = 1.0;  // mean one of the readings
  double level = 0.0;    // variance of the level's walk over a spacing, in those of a reading
  double slope = 0.0;    // the same of the slope (per spacing)
  std::vector<Jump> jumps = {}, kinks = {};  // of the level, of the slope; rising

  /// By restricted likelihood: level and slope of the start are diffuse, the noise is concentrated
  /// out. Jumps are where the shift of the level that the readings ask for is too large for the
  /// walks (the auxiliary residuals of de Jong and Penzer 1998, Diagnosing shocks in time series),
  /// and the shift of the slope is less so; kinks where it is the other way round. REQUIRES three
  /// readings at rising places.
  static LocalTrend of(std::span<const double> at, std::span<const double> readings);

  /// Mean of the quantity at each place, given all readings (Kalman filter and fixed interval
  /// smoother). A reading that is not finite is none.
  [[nodiscard]] std::vector<double> smoothed(std::span<const double> at,
                                             std::span<const double> readings) const;

  /// A draw of the error of smoothed() where the same places are read (Durbin and Koopman 2002, A
  /// simple and efficient simulation smoother), without that of when it jumps.
  [[nodiscard]] std::vector<double> error(std::span<const double> at,
                                          std::span<const double> readings,
                                          RandomStream& random) const;
};

/// Steps between readings that are far larger than most, between steps that are not: where a jump
/// is seen with the eye.
std::vector<LocalTrend::Jump> plain_jumps(std::span<const double> at,
                                          std::span<const double> readings);

}  // namespace slideway
