#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// What the errors of measured causes (the logs of channels) make in each low band at the fitted
/// sizes: Linearisation::errors_of_causes.
std::vector<Eigen::MatrixXd> errors_of_causes(const Model& model, const Linearisation& linear,
                                              const Estimate& estimate);

/// The same of one effect of this size that is not in the model; none where its cause was not
/// measured.
std::vector<Eigen::MatrixXd> errors_of_cause(const Model& model, const Linearisation& linear,
                                             const ModelTerm& term, std::span<const double> shape,
                                             double amplitude);

/// What the effects of the model may differ by from what they are taken as changes in a fit.
/// @param basis  in whose coordinates the information is the unit matrix (Uncertainty)
DepartureResponse response_to_departures(const Model& model, const Linearisation& linear,
                                         const std::vector<Noise>& noise, const Estimate& estimate,
                                         const Eigen::MatrixXd& basis);

}  // namespace slideway
