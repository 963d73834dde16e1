#pragma once

#include <string>
#include <vector>

#include "extended_model.hpp"
#include "search_round.hpp"

/// Effects that join a set without having to pass the gates of a search.
namespace slideway {

/// One effect more, even if noise gives as much; null: none lowers the BIC by Gates::delta_bic.
const TestedCandidate* best_that_is_possible(const SearchRound& round, const Gates& gates,
                                             const std::vector<std::string>& excluded,
                                             Eigen::Index most_unknowns);

/// Number of profiles that have an effect of their own of how they lie on the workpiece.
int count_of_places(const std::vector<AcceptedEffect>& effects);

/// Where count_of_places() is two or more, traces lie off the centre by amounts of their own, and
/// that the next one does, too, is expected. Of a profile of which the set has no such effect, the
/// best that lowers the BIC; null: there is none.
const TestedCandidate* place_of_another(const SearchRound& round,
                                        const std::vector<AcceptedEffect>& effects);

}  // namespace slideway
