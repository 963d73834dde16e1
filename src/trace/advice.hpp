#pragma once

#include <string>
#include <vector>

#include "refine.hpp"
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

}  // namespace slideway
