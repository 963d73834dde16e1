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

/// Wrong directions and starts in the place of effects, where one of time is of all profiles and
/// there is another one: a cut whose clock is wrong has another share of what all have. None where
/// the effects explain the profiles at a lower cost.
std::vector<Blunder> time_blunders_instead(const std::vector<AcceptedEffect>& effects,
                                           const Problem& problem, ModelExtender& extender,
                                           const std::vector<ShownEffect>& shown);

/// Blunders that do not need an effect of time, held against those that do: a drift turns with the
/// direction of the cut as a sign does. A sign that leaves a hundredth of the disagreement and no
/// more than noise of all stands. Of another one, a direction or a start that leaves no more than
/// noise is said instead, if the sign leaves more or costs more; nor is the sign said where the
/// profiles disagree with it turned, too.
std::vector<Blunder> held_against_time(std::vector<Blunder> found, const Problem& problem,
                                       ModelExtender& extender,
                                       const std::vector<ShownEffect>& shown);

}  // namespace slideway
