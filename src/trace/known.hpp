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

Known known_before_search(const Problem& problem, const FittedModel& declared);

}  // namespace slideway
