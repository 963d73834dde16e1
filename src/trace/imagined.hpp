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

/// The cuts on which the effects that the closed loop has found can be evaluated: the log of a
/// measured cause may end before a cut does.
/// @param left_out  is told which cannot, and why
std::vector<CutToCome> with_found_effects(const Problem& problem, const Model& model,
                                          std::vector<CutToCome> cuts,
                                          std::vector<std::string>& left_out);

/// @throws UsageError  the cut lacks metadata of a declared effect, or nothing tells its noise
/// @throws DataError   fewer samples than its low band takes
/// @param band  what `base` is fitted in; null: the declared low band
Imagined imagine(const Problem& problem, const FittedModel& base, const SearchBand* band,
                 const CutToCome& cut);

}  // namespace slideway
