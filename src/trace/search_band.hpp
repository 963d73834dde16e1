#pragma once

#include <memory>
#include <vector>

#include "shown.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// The declared model in the low band that effects are searched in, and the profiles it looks at.
struct SearchBand {
  std::vector<Profile> profiles;
  FittedModel fitted;
};

/// Null where no profile has more values than Gates::search_values: the declared band is searched.
///
/// Where db1 leaves more than kSamplesAValue samples to a value, a profile is looked at in means of
/// neighbours: the low band of equal blocks' means is that of the samples, and a column differs by
/// what it varies within a block, (ω h)² / 24 of a wave of angular frequency ω over a block of
/// length h.
std::unique_ptr<SearchBand> search_band(const Problem& problem,
                                        const std::vector<Profile>& profiles,
                                        const FittedModel& declared,
                                        const std::vector<ShownEffect>& shown);

}  // namespace slideway
