#pragma once

#include <memory>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// A model in the low band that effects are searched in, and the profiles it looks at.
struct SearchBand {
  std::vector<Profile> profiles;
  std::vector<LowBandOptions> low_bands;  // of all samples of each, which the means stand for
  FittedModel fitted;
};

/// The profile with its low band. Where db1 leaves more than eight samples to a value, in means of
/// neighbours: the low band of equal blocks' means is that of the samples, and a column differs by
/// what it varies within a block, (ω h)² / 24 of a wave of angular frequency ω over a block of
/// length h.
Profile in_means(const Profile& profile, LowBandOptions options);

/// Null where no profile has more values than Gates::search_values: the declared band is searched,
/// else profiles in_means().
std::unique_ptr<SearchBand> search_band(const Problem& problem,
                                        const std::vector<Profile>& profiles,
                                        const FittedModel& whole);

}  // namespace slideway
