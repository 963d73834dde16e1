#pragma once

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Noise of every fitted profile from what no effect can reach, so that a missing effect is not
/// taken for noise:
/// - profiles that repeat one another: from their deviations from their mean;
/// - else from the residual with a band of slow cosines, with lines that stand out of the spectrum,
///   and with `suspect` left free (restricted likelihood: what they take is not missed).
///
/// A profile of too few values for that keeps the noise the fit found.
///
/// @param loose    loose_values() of the model
/// @param suspect  per fitted observation: low-band columns of the effect under suspicion, or none
std::vector<Noise> background_noise(const Fit& fit, const Eigen::MatrixXd& loose,
                                    const std::vector<Eigen::MatrixXd>& suspect = {});

/// Unit columns, stacked as Whitened has its rows, for the low-band values within a groove or a
/// value of the spindle axis, where the tool leaves the face, and of a step of the model: the step
/// of each cut lies between two grooves of its own.
Eigen::MatrixXd loose_values(const Model& model, const Fit& fit);

/// cos(π j (i + 1/2) / n), j = 1 ... count: the slow band, n by count.
Eigen::MatrixXd slow_cosines(Eigen::Index n, Eigen::Index count);

/// How many of them a profile of n values is given.
Eigen::Index slow_cosine_count(Eigen::Index n);

}  // namespace slideway
