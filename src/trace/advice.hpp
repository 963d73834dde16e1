#pragma once

#include <string>
#include <vector>

#include "search_round.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// Names the measurement that would tell an effect from its rivals best, out of those a workshop
/// can make of a profile it has (another feed, the other direction, another spindle speed, a
/// diameter, another traverse speed, a later start). For each the separation is predicted: the
/// effect as fitted is put into the data there are and the one to come, and what the best of the
/// rival's shapes leaves of it is the gain expected.
///
/// @param model  with what has been accepted, but for `effect`
std::string separating_measurement(const Problem& problem, const std::vector<Profile>& profiles,
                                   const Model& model, const Solution& fit, const Whitened& data,
                                   const Refined& effect, const Refined& rival);

/// What shows whether a wave of the search is the image of another one: a finer low band.
/// @param is_coarser  whether the search has a coarser one than was declared
std::string finer_band_advice(const Linearisation& linear, const TestedCandidate& wave,
                              bool is_coarser);

}  // namespace slideway
