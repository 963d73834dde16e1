#pragma once

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Noise of every fitted profile from what no effect can reach, so that a missing effect is not
/// taken for noise:
/// - profiles that repeat one another: from their deviations from their mean;
/// - else from the residual without the model, `suspect` and lines that stand out of the spectrum,
///   with a band of slow cosines and those columns left free that are as slow (restricted
///   likelihood: what they take is not missed).
///
/// A profile of too few values for that keeps the noise the fit found.
///
/// @param loose    loose_values() of the model
/// @param suspect  per fitted observation: low-band columns of the effect under suspicion, or none
std::vector<Noise> background_noise(const Solution& fit, const Eigen::MatrixXd& loose,
                                    const std::vector<Eigen::MatrixXd>& suspect = {});

/// Unit columns, stacked as Whitened has its rows, for the low-band values that no column
/// describes:
/// - within a groove or a value of the spindle axis, where the tool leaves the face;
/// - further out, where an effect that is steep at the centre (of the model, or the one under
///   suspicion) is steeper than the tool's nose follows: what it leaves there is the nose;
/// - of a step of the model: the step of each cut lies between two grooves of its own.
///
/// @param noise    per fitted observation
/// @param suspect  stacked low band of an effect that is steep at the centre, or empty
Eigen::MatrixXd loose_values(const Model& model, const Solution& fit,
                             const std::vector<Noise>& noise, const Eigen::VectorXd& suspect = {});

/// Radius out to which effects of the model are steeper at the centre than the tool's nose follows,
/// mm; 0: nowhere.
double lost_centre(const Model& model, const Solution& fit);

/// Leaves the low-band values of all faces within the radius free, each a nuisance of its own.
void leave_out_centre(Model& model, double radius_mm);

/// True if the effect can be steep at the centre: a smooth function of the radius.
bool is_centred(const Effect& effect);

/// cos(π j (i + 1/2) / n), j = 1 ... count: the slow band, n by count.
Eigen::MatrixXd slow_cosines(Eigen::Index n, Eigen::Index count);

/// How many of them a profile of n values is given.
Eigen::Index slow_cosine_count(Eigen::Index n);

}  // namespace slideway
