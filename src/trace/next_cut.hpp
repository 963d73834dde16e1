#pragma once

#include "loop.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// The first line of a plan of cuts_to_come(), without the rest; none where no cut can be tried.
/// @param fitted    the model that the closed loop ended with
/// @param final     what is reported of it
/// @param searched  what the loop has searched with
/// @throws UsageError, DataError
std::optional<NextCut> next_cut(const Problem& problem, const std::vector<Profile>& profiles,
                                const FittedModel& fitted, const ModelResult& final,
                                Searched searched);

}  // namespace slideway
