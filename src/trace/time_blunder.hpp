#pragma once

#include "blunder.hpp"
#include "extended_model.hpp"

namespace slideway {

/// Wrong directions and starts of cuts that show only beside an effect of time which nobody
/// declared: of each profile, the others by themselves say which effects of the cutting time or
/// distance they have, and how that profile would look with another direction or start. Of those
/// that make it agree, the one is said that leaves the least of all profiles, fitted together
/// again.
std::vector<Blunder> find_time_blunders(const Problem& problem, ModelExtender& extender,
                                        const std::vector<ShownEffect>& shown);

/// Blunders that do not need an effect of time, held against those that do: a drift turns with the
/// direction of the cut, so where a turned sign leaves more than noise, a direction or a start that
/// leaves none is said instead.
std::vector<Blunder> held_against_time(std::vector<Blunder> found, const Problem& problem,
                                       ModelExtender& extender,
                                       const std::vector<ShownEffect>& shown);

}  // namespace slideway
