#pragma once

#include "slideway/identify/fit.hpp"
#include "slideway/trace/plan.hpp"

namespace slideway {

/// A cut as a fit sees it. The profile must stay where it is.
struct Imagined {
  Observation observation;
  Noise noise;
};

/// @throws UsageError  the cut lacks metadata of a declared effect, or nothing tells its noise
/// @throws DataError   fewer samples than its low band takes
Imagined imagine(const Problem& problem, const FittedModel& base, const CutToCome& cut);

}  // namespace slideway
