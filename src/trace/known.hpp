#pragma once

#include "shown.hpp"

namespace slideway {

/// What is known of the data before a search for effects.
struct Known {
  std::vector<ShownEffect> shown;
  std::vector<TraceRound> rounds;     // of those that are settled
  std::vector<std::string> notes;     // on values that are left out
  std::optional<FittedModel> fitted;  // with all that; none: as declared
};

/// @param shown  shown_by_samples()
Known known_before_search(std::vector<ShownEffect> shown, const FittedModel& declared);

}  // namespace slideway
