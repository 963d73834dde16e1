#pragma once

#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Holds every profile that was not fitted against its prediction.
///
/// Prediction error e of the low band, levelling free: covariance R + C Σ Cᵀ, with the noise R of
/// the profile, the columns C of the model and the covariance Σ of what was fitted. Directions that
/// the fitted profiles do not determine are left free. R is that of the fitted profiles of the same
/// kind, quantity, base and spacing, the largest in the long run; without one, that of the
/// profile's own fine band. p is four times the smallest of four tail probabilities: of χ² of
/// all values and of the slow band, each near a gamma variable as in LackOfFit, of the largest
/// white error, and of the difference from the fitted profiles that repeat it, which no model makes
/// (probability_beside_repeats()). `at_mm` is where |e| is largest in its standard uncertainties.
/// @param of_each  noise_of_each() fitted profile
std::vector<HeldOutCheck> check_held_out(const Model& model, const Solution& fit,
                                         const std::vector<Noise>& of_each);

}  // namespace slideway
