#pragma once

#include <string>
#include <vector>

#include "search_round.hpp"
#include "slideway/identify/fit.hpp"

namespace slideway {

/// What the same profiles choose one level up and one level down, among the candidates of a search
/// at the shapes that it gave (Ballot). The noise is that beside the effect there. A level that a
/// profile does not have has no say.
///
/// @param fitted  the model that was searched
std::vector<std::string> chosen_at_other_levels(const FittedModel& fitted, const SearchRound& round,
                                                const TestedCandidate& effect);

}  // namespace slideway
