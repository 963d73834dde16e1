#pragma once

#include <string>

#include "ballot.hpp"
#include "search_round.hpp"

namespace slideway {

/// How often resamples of the data choose the same effect among the candidates of one search.
struct Stability {
  double share = 1.0;  // of the resamples
  std::string other;   // what the rest choose most often; or kNothing; "": none do
};

/// Resamples: each profile left out, alternate blocks of a sixteenth and an eighth of each profile
/// left out, either half, noise drawn anew on what the effect makes, and where the fit is given,
/// the low bands one level up and one level down (other_level.hpp). A profile counts as left out
/// only if it is not the only one that shows the effect. Each resample chooses the candidate of
/// least BIC at the shapes all data gave, and this effect if none is better by Gates::tie_bic;
/// gains of parts are scaled to the number of all rows.
///
/// @param fitted  the model that was searched; null: no other levels
Stability stability(const SearchRound& round, const TestedCandidate& effect, const Gates& gates,
                    const FittedModel* fitted = nullptr);

}  // namespace slideway
