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

}  // namespace slideway
