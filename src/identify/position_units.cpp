#include "position_units.hpp"

#include <array>
#include <cmath>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::array kRatiosOfUnits{1000.0, 25.4};
constexpr double kNearRatio = 0.05;

double length_of_trace(const Profile& profile) {
  return profile.setup.last_mm - profile.setup.first_mm;
}

/// The ratio of two units that the lengths of two traces have; 0: none.
double ratio_of_units(const Profile& a, const Profile& b) {
  const double ratio = std::exp(std::abs(std::log(length_of_trace(a) / length_of_trace(b))));
  for (const double each : kRatiosOfUnits)
    if (std::abs(ratio / each - 1.0) <= kNearRatio) return each;
  return 0.0;
}

}  // namespace

void note_other_position_units(std::vector<Profile>& profiles) {
  for (auto profile = profiles.begin(); profile != profiles.end(); ++profile) {
    auto other = profiles.end();
    int unlike = 0, alike = 1;
    for (auto sister = profiles.begin(); sister != profiles.end(); ++sister) {
      if (sister == profile || sister->setup.kind != profile->setup.kind) continue;
      const bool differs = ratio_of_units(*profile, *sister) > 0.0;
      ++(differs ? unlike : alike);
      if (differs && other == profiles.end()) other = sister;
    }
    if (unlike < alike || (unlike == alike && other > profile)) continue;
    profile->doubts.push_back(
        "positions of " + profile->name + " may be in another unit: its trace is " +
        significant(ratio_of_units(*profile, *other), 3) + " times " +
        (length_of_trace(*profile) < length_of_trace(*other) ? "shorter" : "longer") +
        " than that of " + other->name);
  }
}

}  // namespace slideway
