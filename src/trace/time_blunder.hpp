#pragma once

#include "blunder.hpp"
#include "selection.hpp"
#include "shown.hpp"

namespace slideway {

/// Blunders that show only beside an effect of time which nobody declared: of each profile, the
/// others by themselves say which effects of the cutting time or distance they have, and how that
/// profile would look with another direction, start, sign or unit. Of those that make it agree, the
/// one is said that leaves the least of all profiles, fitted together again.
std::vector<Blunder> find_time_blunders(const Problem& problem, ModelExtender& extender,
                                        const std::vector<ShownEffect>& shown);

/// A blunder, and the profiles fitted with an effect of time, one of them corrected.
struct TimeBlunder {
  Blunder blunder;
  double cost = 0.0;  // square of the white residual, with the price of the effect
  std::shared_ptr<const FittedModel> fitted;  // without observations
};

/// Blunders in the place of effects of time.
struct TimeBlundersInPlace {
  std::vector<Blunder> better;       // the effects do not explain the profiles at so low a cost
  std::vector<TimeBlunder> as_good;  // those within tie_bic of the effects
};

/// A cut whose clock is wrong has another share of what all have. So it is held against effects
/// where one of time is of all profiles and there is another one, or one has a size of its own in
/// several profiles; and as a rival where one of time is of some profiles alone.
TimeBlundersInPlace time_blunders_in_place(const std::vector<AcceptedEffect>& effects,
                                           const Problem& problem, ModelExtender& extender,
                                           const std::vector<ShownEffect>& shown);

/// Says beside the effects of time of some profiles alone that blunders explain as much.
void add_as_rivals(const std::vector<TimeBlunder>& blunders, Selection& selection);

/// Blunders that do not need an effect of time, held against those that do: a drift turns with the
/// direction of the cut as a sign does. A sign that leaves a hundredth of the disagreement and no
/// more than noise of all stands. Of another one, a direction or a start that leaves no more than
/// noise is said instead, if the sign leaves more or costs more; nor is the sign said where the
/// profiles disagree with it turned, too.
std::vector<Blunder> held_against_time(std::vector<Blunder> found, const Problem& problem,
                                       ModelExtender& extender,
                                       const std::vector<ShownEffect>& shown);

}  // namespace slideway
