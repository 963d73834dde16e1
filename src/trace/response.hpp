#pragma once

#include <Eigen/Core>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/profile_bases.hpp"

namespace slideway {

/// Change of a fit's (amplitudes, shapes) by signals in its low bands: G⁺ W s under the noise of
/// the fit, with G the model's columns beside the levelling.
/// @param signals  a column each, the low bands under one another
Eigen::MatrixXd response(const Solution& fit, Eigen::MatrixXd signals);

/// Change of weighted sums of a fit's (amplitudes, shapes): the weights of the low-band values in
/// them, made once for many signals.
class RowResponse {
 public:
  /// @param rows  of (amplitudes, shapes), one a sum
  /// @param free  values that the fit would leave out
  RowResponse(const Solution& fit, const Eigen::MatrixXd& rows, const FreeValues& free = {});

  [[nodiscard]] Eigen::VectorXd to(Eigen::VectorXd signal) const;

 private:
  const Solution& fit_;
  Eigen::MatrixXd weights_;  // of white values, a column each sum
};

}  // namespace slideway
