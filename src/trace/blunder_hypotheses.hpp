#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "slideway/base/units.hpp"
#include "slideway/profile/profile.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// How a profile may have been meant.
struct BlunderHypothesis {
  BlunderKind kind = BlunderKind::sign;
  double factor = 1.0;             // of the values
  std::optional<Profile> profile;  // with other positions or another setup; none: as it is
};

inline constexpr double kArcsecondInMicroradian = kArcsecond / kMicroradian;
/// Slips of the values, and the factors that undo them.
inline constexpr std::array<std::pair<BlunderKind, double>, 7> kFactors{
    {{BlunderKind::sign, -1.0},
     {BlunderKind::inch, 25.4},
     {BlunderKind::per_inch, 1 / 25.4},
     {BlunderKind::metre, 1000.0},
     {BlunderKind::per_metre, 1e-3},
     {BlunderKind::arcsecond, kArcsecondInMicroradian},
     {BlunderKind::per_arcsecond, 1 / kArcsecondInMicroradian}}};

/// Whether readings of that quantity can have it.
bool is_possible(BlunderKind kind, const Setup& setup);

/// Of the trace, mm.
inline double length_of(const Profile& profile) {
  return profile.setup.last_mm - profile.setup.first_mm;
}

/// All but the profile as it is.
/// @param is_reversal  others were read the other way round: with the other sign what is the
///                     slide's and what is the artefact's would change places, and both fit
std::vector<BlunderHypothesis> hypotheses(const Profile& profile,
                                          const std::vector<double>& other_lengths,
                                          bool is_reversal);

}  // namespace slideway
