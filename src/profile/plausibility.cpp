#include "plausibility.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/statistics.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr double kLargestRange = 1.0;    // mm: a face or a slide is turned or scraped flatter
constexpr double kLongestCut = 24.0;     // h: no edge lasts longer
constexpr double kFastestSurface = 1e4;  // m/min: beyond it nothing is turned
constexpr double kLargestRadius = 2e4;   // mm: vertical lathes turn up to 40 m across
constexpr double kMinutesPerHour = 60.0;

// What lathes and instruments have.
struct Usual {
  const char* key;
  double least, most;
  const char* why;
};
constexpr Usual kFeed{"feed_mm_per_min", 0.01, 1e4, "lathes feed at 0.01 to 10000 mm/min"};
constexpr Usual kSpeed{"spindle_rpm", 0.1, 1e5, "spindles turn at 0.1 to 100000 rev/min"};
constexpr Usual kNose{"nose_radius_mm", 1e-3, 200.0, "noses have 0.001 to 200 mm"};
constexpr Usual kOverhang{"overhang_mm", 0.0, 3000.0, "holders reach out 3 m at most"};
constexpr Usual kZ{"z_mm", 0.0, 3e4, "lathes travel 30 m at most"};
constexpr Usual kSpindle{"spindle_position_mm", 0.0, 3e4, "lathes travel 30 m at most"};
constexpr Usual kBase{"base_mm", 0.1, 3000.0, "mirrors and levels stand on 0.1 mm to 3 m"};
constexpr Usual kTraverse{"traverse_mm_per_s", 1e-3, 1e3, "styli travel at 0.001 to 1000 mm/s"};
constexpr Usual kStart{"start_s", 0.0, 30.0 * 86400.0, "a month lies between two cuts at most"};

void note(Profile& profile, const Usual& usual, const std::optional<double>& value) {
  if (!value || *value == 0.0) return;
  const double size = std::abs(*value);
  if (size >= usual.least && size <= usual.most) return;
  profile.doubts.push_back(std::string(usual.key) + " = " + shortest(*value) + ", but " +
                           usual.why + ": is it right?");
}

void note_cut(Profile& profile) {
  const Setup& setup = profile.setup;
  const double travel =
      setup.kind == Kind::face ? setup.cut_radius_mm.value_or(0.0) : setup.last_mm - setup.first_mm;
  if (setup.feed_mm_per_min) {
    const double hours = travel / *setup.feed_mm_per_min / kMinutesPerHour;
    if (hours > kLongestCut)
      profile.doubts.push_back("feed_mm_per_min = " + shortest(*setup.feed_mm_per_min) +
                               " makes a cut of " + significant(hours, 2) + " h: is it in mm/min?");
  }
  if (setup.kind != Kind::face || !setup.cut_radius_mm) return;
  const double radius = *setup.cut_radius_mm;
  if (radius > kLargestRadius)
    profile.doubts.push_back("the cut has a radius of " + significant(radius / 1e3, 3) +
                             " m, more than any lathe turns: are center_mm and the units right?");
  const double speed = 2e-3 * kPi * radius * setup.spindle_rpm.value_or(0.0);
  if (speed > kFastestSurface)
    profile.doubts.push_back("the rim runs at " + significant(speed, 3) +
                             " m/min, faster than anything is turned: are spindle_rpm and the unit "
                             "of the positions right?");
}

void note_centre(Profile& profile) {
  const Setup& setup = profile.setup;
  if (setup.kind != Kind::face) return;
  note(profile, kSpindle, setup.spindle_position_mm);
  const double outside =
      std::max(setup.first_mm - setup.center_mm, setup.center_mm - setup.last_mm);
  const double length = setup.last_mm - setup.first_mm;
  if (outside > length)
    profile.doubts.push_back("the spindle axis lies " + significant(outside, 3) +
                             " mm outside a trace of " + significant(length, 3) +
                             " mm: a ring, or is center_mm wrong?");
}

}  // namespace

void note_implausible_values(Profile& profile) {
  const Statistics values = statistics_of(profile.values);
  const double range = values.largest - values.least;
  if (profile.setup.quantity == Quantity::height && range > kLargestRange)
    profile.doubts.push_back("heights range over " + significant(range, 3) +
                             " mm, more than 1 mm: is value_unit right?");
  if (!(range > 0.0) && profile.values.size() > 1)
    profile.doubts.emplace_back("all values are the same: is value_column right?");
}

void note_implausible_setup(Profile& profile) {
  const Setup& setup = profile.setup;
  note(profile, kFeed, setup.feed_mm_per_min);
  note(profile, kSpeed, setup.spindle_rpm);
  note(profile, kNose, setup.nose_radius_mm);
  note(profile, kOverhang, setup.overhang_mm);
  note(profile, kZ, setup.z_mm);
  note(profile, kBase, setup.base_mm);
  note(profile, kTraverse, setup.traverse_mm_per_s);
  note(profile, kStart, setup.start_s);
  note_cut(profile);
  note_centre(profile);
}

}  // namespace slideway
