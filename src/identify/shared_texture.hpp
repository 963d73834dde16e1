#pragma once

#include <optional>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/noise.hpp"

namespace slideway {

/// Readings of one face have in common what the tool left from turn to turn, at one radius all
/// round: repeats, traces at other azimuths, and both halves of a diameter. Each weighs by what it
/// does not have in common with the others: Noise::repeated() by 1 + their number times the share
/// that is common, that of repeats and that of other places by themselves. What readings of a slide
/// have in common is its form. A declared noise stays as it is.
///
/// With C the mean product of what the slow band leaves of two readings at one radius, V its mean
/// variance beside white noise and W that of the white noise, the share of V is min(C / V, 1) and
/// that of W min((C - V) / W, 1); both 0 where two unrelated noises could have as large a C.
///
/// An effect that the model lacks may look alike at two places, too. So other places count where
/// the noise is nearly white and the model and the suspects leave no lack of fit beside it: turns
/// alone explain what is left.
/// @param fine     what the slow band leaves of each profile; nothing: it says nothing
/// @param suspect  as noise_beside()
void weigh_shared_texture(const Linearisation& linear,
                          const std::vector<std::optional<LinearProfile>>& fine,
                          const std::vector<Eigen::MatrixXd>& suspect, const Gates& gates,
                          std::vector<Noise>& noise);

/// The same of the halves of a diameter alone: what other readings of one face have in common with
/// it is not in their difference.
/// @param alone  one profile, fitted alone
void weigh_halves(const Linearisation& alone, const std::optional<LinearProfile>& fine,
                  const Gates& gates, Noise& noise);

}  // namespace slideway
