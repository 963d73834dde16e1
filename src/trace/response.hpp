#pragma once

#include <Eigen/Core>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/profile_bases.hpp"

namespace slideway {

/// Change of a fit's (amplitudes, shapes) by signals in its low bands: G⁺ W s under the noise of
/// the fit, with G the model's columns beside the levelling.
/// @param signals  a column each, the low bands under one another
Eigen::MatrixXd response(const Solution& fit, Eigen::MatrixXd signals);

/// Change of one parameter of a fit: the weights of the low-band values in it, made once for many
/// signals.
class ParameterResponse {
 public:
  /// @param parameter  its row of fit.parameters.jacobian
  /// @param free       values that the fit would leave out
  ParameterResponse(const Solution& fit, Eigen::Index parameter, const FreeValues& free = {});

  [[nodiscard]] double to(Eigen::VectorXd signal) const;

 private:
  const Solution& fit_;
  Eigen::RowVectorXd weights_;  // of white values
};

}  // namespace slideway
