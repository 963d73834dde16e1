#pragma once

#include <memory>

#include "search_band.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/trace/plan.hpp"

namespace slideway {

/// A cut as a fit sees it.
struct Imagined {
  std::shared_ptr<const Profile> profile;
  Observation observation;
  Noise noise;
};

/// What an effect lacks on a cut to come: "effect 'linear_drift' needs feed_mm_per_min", or "".
std::string lacks(const ModelTerm& term, const CutToCome& cut);

/// @throws UsageError  the cut lacks metadata of a declared effect, or nothing tells its noise
/// @throws DataError   fewer samples than its low band takes
/// @param band  what `base` is fitted in; null: the declared low band
Imagined imagine(const Problem& problem, const FittedModel& base, const SearchBand* band,
                 const CutToCome& cut);

}  // namespace slideway
