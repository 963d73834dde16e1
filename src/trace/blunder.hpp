#pragma once

#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// Slips of the hand that would make one fitted profile agree with the others, most likely first;
/// those within Gates::tie_bic of the first are its rivals. Empty: no profile disagrees, or none of
/// these explains it.
///
/// Each profile is predicted from the fit of all others, its levelling free. Its values e = f y - C
/// a have the covariance s² R + C Σ Cᵀ with Σ of the others' fit, the noise R of a profile read in
/// the same way, and its size s free but for a normal prior on ln s (Gates::sister_factor; as it
/// is, s may be any: a profile of another noise is no blunder). The likelihood of the values y as
/// they were recorded, |f|ⁿ times that of e, is compared between "as it is", other factors f (sign,
/// inch, metre) and other columns C (direction and start of the cut; positions in another unit,
/// where that makes the trace about as long as the others). A blunder takes away most of the
/// disagreement, not only some of it.
std::vector<Blunder> find_blunders(const FittedModel& fitted);

/// Whether it is another unit of the positions.
inline bool is_of_positions(BlunderKind kind) {
  return BlunderKind::position_inch <= kind && kind <= BlunderKind::position_per_metre;
}

/// A blunder, and the profile as it was meant.
struct CorrectedBlunder {
  Blunder blunder;
  Profile meant;
  double factor = 1.0;  // of its values
};

/// Of one profile, those of its values and of the time of its cut, its start moved to the best.
std::vector<CorrectedBlunder> find_blunders_in(const FittedModel& fitted,
                                               const std::string& profile);

/// What to do about them, in a sentence. REQUIRES one.
std::string blunder_advice(const std::vector<Blunder>& blunders);

}  // namespace slideway
