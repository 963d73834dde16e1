#include <algorithm>
#include <cmath>
#include <memory>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/trace/plan.hpp"

namespace slideway {
namespace {

// What a workshop can change: far enough for a second look, near enough for the same machine.
constexpr double kFeeds[] = {0.25, 4.0};        // of the feed there is
constexpr double kSpeeds[] = {2.0 / 3.0, 1.5};  // of the spindle speed there is
constexpr double kAzimuths[] = {40.0, 80.0};    // degrees; no two lobes of 2, 3, 4 alike
constexpr double kLevels[] = {0.5, 1.0};        // of the radius, beyond the levels there are
constexpr double kOtherOverhang = 50.0;         // mm
constexpr double kLongestCut = 60.0;            // min, where no cut there is took as long

void complete(Profile& profile) {
  profile.role = Role::fit;
  profile.outliers.clear();
  profile.doubts.clear();
  profile.values.assign(profile.positions.size(), 0.0);
  try {
    complete_setup(profile);
  } catch (const KeyError& error) {
    throw UsageError("planned cut '" + profile.name + "': " + error.key + ": " + error.what());
  }
}

/// Of a face from its largest radius to its smallest.
double machining_min(const Profile& profile) {
  const Setup& setup = profile.setup;
  const double first = setup.first_mm - setup.center_mm, last = setup.last_mm - setup.center_mm;
  const bool is_face = setup.kind == Kind::face;
  const double inner =
      is_face && first * last > 0.0 ? std::min(std::abs(first), std::abs(last)) : 0.0;
  const double length = is_face ? std::max(std::abs(first), std::abs(last)) - inner : last - first;
  return length / *setup.feed_mm_per_min;
}

// --- [[plan.cut]] -------------------------------------------------------------------------------

double in_mm(const PlannedCut& cut, double position) {
  const auto unit = length_unit(cut.entry.source.position_unit);  // or s
  const UnitScale scale =
      unit ? *unit : UnitScale{*cut.entry.profile.setup.feed_mm_per_min, kMinute};
  return scale(position);
}

/// Evenly spaced in the window, or the positions of the profile it is like.
std::vector<double> positions_of(const PlannedCut& cut, const Profile* like) {
  if (!cut.entry.source.window) return like->positions;
  const double first = in_mm(cut, cut.entry.source.window->first),
               last = in_mm(cut, cut.entry.source.window->second);
  std::size_t samples = cut.samples;
  if (samples == 0) {
    const double step = (like->positions.back() - like->positions.front()) /
                        static_cast<double>(like->positions.size() - 1);
    samples = std::max<std::size_t>(2, std::lround((last - first) / step) + 1);
  }
  std::vector<double> out(samples);
  for (std::size_t i = 0; i < samples; ++i)
    out[i] = first + (last - first) * static_cast<double>(i) / static_cast<double>(samples - 1);
  return out;
}

/// The same stations read from the other end, in the same time.
std::shared_ptr<const ReadingTimes> backwards(ReadingTimes times) {
  const auto [first, last] = std::ranges::minmax(times.times_s);
  for (double& time : times.times_s) time = first + (last - time);
  return std::make_shared<const ReadingTimes>(std::move(times));
}

/// When the stations of a pass along the slide are read: as those of the one it is like, or from
/// the other end where it goes the other way.
std::shared_ptr<const ReadingTimes> times_of(const Setup& pass, const Setup& like) {
  const std::shared_ptr<const ReadingTimes>& times = like.reading_times;
  if (!times || pass.kind == Kind::face || !pass.cut_direction) return times;
  const bool rises = times->times_s.back() >= times->times_s.front();
  return (pass.cut_direction == CutDirection::outward) == rises ? times : backwards(*times);
}

/// The keys in which a cut differs from a profile, in words.
std::string difference(const Setup& cut, const Setup& like) {
  std::vector<std::string> out;
  const auto say = [&](const char* before, double value, const char* unit) {
    out.push_back(before + significant(value, 4) + unit);
  };
  if (cut.feed_mm_per_min && cut.feed_mm_per_min != like.feed_mm_per_min)
    say("at ", *cut.feed_mm_per_min, " mm/min");
  if (cut.spindle_rpm && cut.spindle_rpm != like.spindle_rpm)
    say("at ", *cut.spindle_rpm, " rev/min");
  if (cut.cut_direction && cut.cut_direction != like.cut_direction)
    out.emplace_back(cut.cut_direction == CutDirection::inward ? "inward" : "outward");
  if (cut.z_mm != like.z_mm) say("at z = ", cut.z_mm, " mm");
  if (cut.overhang_mm != like.overhang_mm) say("with the overhang ", cut.overhang_mm, " mm");
  if (cut.azimuth_deg != like.azimuth_deg) say("at the azimuth ", cut.azimuth_deg, "°");
  if (cut.traverse_mm_per_s && cut.traverse_mm_per_s != like.traverse_mm_per_s)
    say("traced at ", *cut.traverse_mm_per_s, " mm/s");
  if (cut.start_s != like.start_s) say("begun at ", cut.start_s, " s");
  if (cut.base_mm && cut.base_mm != like.base_mm) say("on a base of ", *cut.base_mm, " mm");
  if (cut.first_mm != like.first_mm || cut.last_mm != like.last_mm)
    out.push_back("from " + significant(cut.first_mm, 4) + " to " + significant(cut.last_mm, 4) +
                  " mm");
  return joined(out);
}

CutToCome to_come(const PlannedCut& cut, const std::vector<Profile>& profiles) {
  const auto like = std::ranges::find(profiles, cut.like, &Profile::name);
  const bool is_new = like == profiles.end();
  CutToCome out{"", cut.like, cut.entry.profile, cut.cost, cut.time_min};
  if (!is_new && !cut.entry.source.window && !out.profile.setup.cut_radius_mm)
    out.profile.setup.cut_radius_mm = like->setup.cut_radius_mm;
  if (!is_new) out.profile.setup.reading_times = times_of(out.profile.setup, like->setup);
  out.profile.positions = positions_of(cut, is_new ? nullptr : &*like);
  complete(out.profile);
  const std::string what = out.profile.setup.kind == Kind::face ? "a cut" : "a pass";
  const std::string changed = is_new ? "" : difference(out.profile.setup, like->setup);
  out.what = is_new ? what : changed.empty() ? what + " as " + cut.like : what + " " + changed;
  return out;
}

// --- the workshop's range -----------------------------------------------------------------------

/// Cuts that differ from one profile in one thing each.
class Range {
 public:
  explicit Range(const Profile& like) : like_(like) {}

  /// @param is_cut  it takes a cut, not a trace alone
  template <typename Change>
  void add(const std::string& suffix, std::string what, bool is_cut, Change&& change) {
    CutToCome& cut = cuts.emplace_back(CutToCome{std::move(what), like_.name, like_, {}, {}});
    Profile& profile = cut.profile;
    profile.name = like_.name + "-" + suffix;
    profile.file = profile.name + ".csv";
    profile.standard_uncertainty = like_.standard_uncertainty;
    profile.line.reset();
    if (is_cut) profile.surface.reset();
    change(profile);
    complete(profile);
    const Setup& setup = profile.setup;
    if (is_cut && setup.feed_mm_per_min)
      cut.time_min = machining_min(profile);
    else if (!is_cut && setup.traverse_mm_per_s)
      cut.time_min = (setup.last_mm - setup.first_mm) / *setup.traverse_mm_per_s / kMinute;
  }

  std::vector<CutToCome> cuts;

 private:
  const Profile& like_;
};

void add_once_more(const Profile& like, Range& out) {
  out.add("again", like.setup.kind == Kind::face ? "the same cut once more" : "the same pass again",
          true, [](Profile&) {});
}

void add_speeds(const Profile& like, Range& out) {
  const Setup& setup = like.setup;
  const std::string made = setup.kind == Kind::face ? "a cut" : "a pass";
  if (setup.feed_mm_per_min)
    for (const double factor : kFeeds) {
      const double feed = factor * *setup.feed_mm_per_min;
      out.add("feed" + significant(feed, 4), made + " at " + significant(feed, 4) + " mm/min", true,
              [&](Profile& p) { p.setup.feed_mm_per_min = feed; });
    }
  if (setup.spindle_rpm)
    for (const double factor : kSpeeds) {
      const double rpm = std::round(factor * *setup.spindle_rpm);
      out.add("rpm" + significant(rpm, 6), made + " at " + significant(rpm, 6) + " rev/min", true,
              [&](Profile& p) { p.setup.spindle_rpm = rpm; });
    }
}

void add_direction(const Profile& like, Range& out) {
  if (like.setup.reading_times)
    out.add("back", "the pass back", false,
            [&](Profile& p) { p.setup.reading_times = backwards(*like.setup.reading_times); });
  if (!like.setup.cut_direction || like.setup.reading_times) return;
  const bool inward = like.setup.cut_direction == CutDirection::inward;
  const bool is_face = like.setup.kind == Kind::face;
  const std::string name = inward ? "outward" : "inward";
  out.add(is_face ? name : "back", is_face ? "a cut " + name : "the pass back", true,
          [&](Profile& p) {
            p.setup.cut_direction = inward ? CutDirection::outward : CutDirection::inward;
          });
}

void mirror_at_axis(Profile& profile) {
  const double center = profile.setup.center_mm;
  std::erase_if(profile.positions, [&](double s) { return !(s > center); });
  for (std::size_t i = profile.positions.size(); i-- > 0;)
    profile.positions.push_back(2.0 * center - profile.positions[i]);
  std::ranges::sort(profile.positions);
}

void add_traces(const Profile& like, Range& out) {
  const Setup& setup = like.setup;
  if (setup.first_mm >= setup.center_mm)
    out.add("diameter", "a trace over the whole diameter", false, mirror_at_axis);
  const std::string surface = like.surface.value_or(like.name);
  for (const double turn : kAzimuths) {
    const double azimuth = std::fmod(setup.azimuth_deg + turn, 360.0);
    out.add("azimuth" + significant(azimuth, 4),
            "a trace at the azimuth " + significant(azimuth, 4) + "°", false, [&](Profile& p) {
              p.setup.azimuth_deg = azimuth;
              p.surface = surface;
            });
  }
}

void add_levels(const Profile& like, double highest_mm, Lever lever, Range& out) {
  for (const double share : kLevels) {
    const double z = highest_mm + share * *like.setup.cut_radius_mm;
    out.add("z" + significant(z, 4), "a cut at z = " + significant(z, 4) + " mm", true,
            [&](Profile& p) { p.setup.z_mm = z; });
  }
  if (lever != Lever::split) return;
  const double overhang = like.setup.overhang_mm + kOtherOverhang;
  out.add("overhang" + significant(overhang, 4),
          "a cut with the overhang " + significant(overhang, 4) + " mm", true,
          [&](Profile& p) { p.setup.overhang_mm = overhang; });
}

}  // namespace

std::vector<CutToCome> cuts_to_come(const Problem& problem, const std::vector<Profile>& profiles) {
  if (!problem.planned.empty()) {
    std::vector<CutToCome> out;
    for (const PlannedCut& cut : problem.planned) out.push_back(to_come(cut, profiles));
    return out;
  }
  const auto is_fitted = [](const Profile& each) { return each.role == Role::fit; };
  const auto is_fitted_face = [&](const Profile& each) {
    return is_fitted(each) && each.setup.kind == Kind::face;
  };
  auto like = std::ranges::find_if(profiles, is_fitted_face);
  if (like == profiles.end()) like = std::ranges::find_if(profiles, is_fitted);
  if (like == profiles.end()) throw UsageError("no profile has role = \"fit\"");
  Range range(*like);
  add_once_more(*like, range);
  add_speeds(*like, range);
  add_direction(*like, range);
  if (like->setup.kind == Kind::face) {
    double highest = like->setup.z_mm;
    for (const Profile& each : profiles) highest = std::max(highest, each.setup.z_mm);
    add_traces(*like, range);
    add_levels(*like, highest, problem.lever, range);
  }
  double longest = kLongestCut;
  for (const Profile& each : profiles)
    if (is_fitted(each) && each.setup.feed_mm_per_min)
      longest = std::max(longest, machining_min(each));
  std::erase_if(range.cuts, [&](const CutToCome& cut) { return cut.time_min > longest; });
  return std::move(range.cuts);
}

}  // namespace slideway
