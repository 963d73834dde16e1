#pragma once

#include <span>
#include <vector>

#include "slideway/base/random.hpp"

namespace slideway {

/// A quantity whose level and slope are random walks in continuous time, read with white noise: the
/// local linear trend (Harvey 1989, Forecasting, structural time series models and the Kalman
/// filter, sections 2.3.2 and 9.2). Without a walk of the level its mean is the cubic smoothing
/// spline.
struct LocalTrend {
  double noise = 0.0;    // standard deviation of a reading
  double spacing = 1.0;  // mean one of the readings
  double level = 0.0;    // variance of the level's walk over a spacing, in those of a reading
  double slope = 0.0;    // the same of the slope (per spacing)

  /// By restricted likelihood: level and slope of the start are diffuse, the noise is concentrated
  /// out. REQUIRES three readings at rising places.
  static LocalTrend of(std::span<const double> at, std::span<const double> readings);

  /// Mean of the quantity at each place, given all readings (Kalman filter and fixed interval
  /// smoother). A reading that is not finite is none.
  [[nodiscard]] std::vector<double> smoothed(std::span<const double> at,
                                             std::span<const double> readings) const;

  /// A draw of the error of smoothed() where the same places are read (Durbin and Koopman 2002, A
  /// simple and efficient simulation smoother).
  [[nodiscard]] std::vector<double> error(std::span<const double> at,
                                          std::span<const double> readings,
                                          RandomStream& random) const;
};

}  // namespace slideway
