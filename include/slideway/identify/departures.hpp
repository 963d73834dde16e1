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

/// Unit directions in which errors of causes, one profile's, are larger than what a residual has
/// beside them: there it says nothing of the noise.
Eigen::MatrixXd directions_of_causes(const Eigen::MatrixXd& errors, Eigen::VectorXd residual);
/// The same of a linearisation, one column a direction.
Eigen::MatrixXd directions_of_causes(const Linearisation& linear, std::size_t observation);

/// What the effects of the model may differ by from what they are taken as changes in a fit.
/// @param basis  in whose coordinates the information is the unit matrix (Uncertainty)
DepartureResponse response_to_departures(const Model& model, const Linearisation& linear,
                                         const std::vector<Noise>& noise, const Estimate& estimate,
                                         const Eigen::MatrixXd& basis);

}  // namespace slideway
