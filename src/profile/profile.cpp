#include "slideway/profile/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {

/// mm or rad. Beyond it lie the marks some instruments write for a missing value (1e38).
constexpr double kLargest = 1e9;

[[noreturn]] void refuse_order(const std::string& file, std::size_t row, double now, double last) {
  throw DataError(file + ": data row " + std::to_string(row) + ": position " + shortest(now) +
                  " follows " + shortest(last) +
                  "; positions must strictly increase (or strictly decrease)");
}

// Keeps the samples inside the window, in place and in our units. Returns whether they run upwards.
bool keep_window(const ProfileSource& source, const UnitScale& to_mm,
                 std::vector<double>& positions, std::vector<double>& values) {
  std::size_t kept = 0;
  bool upwards = true;
  double last = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double given = positions[i];
    if (source.window && !(given >= source.window->first && given <= source.window->second))
      continue;
    const double position = to_mm(source.position_unit(given));
    const double value = source.value_unit(values[i]);
    if (!(std::abs(position) <= kLargest && std::abs(value) <= kLargest))
      throw DataError(source.path.string() + ": data row " + std::to_string(i + 1) +
                      ": too large for its unit; the largest accepted: 1e9 mm or rad");
    if (kept == 1) upwards = position > positions[0];
    if (kept > 0) {
      const double step = position - positions[kept - 1];
      if (upwards ? !(step > 0.0) : !(step < 0.0))
        refuse_order(source.path.string(), i + 1, given, last);
    }
    last = given;
    positions[kept] = position;
    values[kept] = value;
    ++kept;
  }
  positions.resize(kept);
  values.resize(kept);
  return upwards;
}

void require_two_samples(const ProfileSource& source, std::size_t count) {
  if (count >= 2) return;
  std::string where = count == 1 ? "1 sample" : "no sample";
  if (source.window)
    where += " in the window [" + shortest(source.window->first) + ", " +
             shortest(source.window->second) + "]";
  throw DataError(source.path.string() + ": " + where + ", at least 2 are needed");
}

// The end of the trace that lies furthest from the spindle axis was cut, so the cut reached it.
void complete_cut_radius(const std::string& name, Setup& setup) {
  if (setup.kind != Kind::face) return;
  const double reach = std::max(std::abs(setup.first_mm - setup.center_mm),
                                std::abs(setup.last_mm - setup.center_mm));
  if (!setup.cut_radius_mm) setup.cut_radius_mm = reach;
  if (*setup.cut_radius_mm >= reach * (1.0 - 1e-9)) return;
  throw UsageError("profile '" + name + "': cut_radius_mm = " + shortest(*setup.cut_radius_mm) +
                   " but the trace reaches r = " + significant(reach, 9) +
                   "; give the outer radius of the cut, the right center_mm, or a window");
}

}  // namespace

void read_profile(const ProfileSource& source, Profile& profile) {
  Setup& setup = profile.setup;
  UnitScale to_mm;
  if (source.position_is_time) {
    if (!setup.feed_mm_per_min)
      throw UsageError("profile '" + profile.name +
                       "': positions in time need feed_mm_per_min to become mm");
    to_mm = {*setup.feed_mm_per_min, kMinute};
  }
  const std::array<std::string, 2> columns{source.position_column, source.value_column};
  Table table = read_table(source.path, columns);
  profile.sha256 = std::move(table.sha256);
  profile.positions = std::move(table.columns[0]);
  profile.values = std::move(table.columns[1]);

  const bool upwards = keep_window(source, to_mm, profile.positions, profile.values);
  require_two_samples(source, profile.positions.size());
  if (!upwards) {
    std::reverse(profile.positions.begin(), profile.positions.end());
    std::reverse(profile.values.begin(), profile.values.end());
    profile.notes.emplace_back("trace runs backwards in the file: reversed");
  }
  setup.first_mm = profile.positions.front();
  setup.last_mm = profile.positions.back();
  complete_cut_radius(profile.name, setup);
}

}  // namespace slideway
