#pragma once

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Change of (amplitudes, shapes) by draws of the errors of measured causes (the logs of channels),
/// a column each, divided by the root of their number: R Rᵀ is what they add to the covariance of a
/// fit (a Berkson error: Carroll et al. 2006, Measurement Error in Nonlinear Models,
/// section 2.2.3). No column: the model has no measured cause.
/// @param basis  in whose coordinates the information is the unit matrix (Uncertainty)
Eigen::MatrixXd response_to_causes(const Model& model, const Linearisation& linear,
                                   const std::vector<Noise>& noise, const Estimate& estimate,
                                   const Eigen::MatrixXd& basis);

}  // namespace slideway
