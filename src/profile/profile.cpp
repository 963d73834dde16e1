#include "slideway/profile/profile.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "intake.hpp"
#include "plausibility.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/base/text.hpp"
#include "slideway/profile/given.hpp"

namespace slideway {
namespace {

void require_two_samples(const ProfileSource& source, std::size_t count) {
  if (count >= 2) return;
  std::string where = count == 1 ? "1 sample" : "no sample";
  if (source.window)
    where += " in the window [" + shortest(source.window->first) + ", " +
             shortest(source.window->second) + "]";
  throw DataError(source.path.string() + ": " + where + ", at least 2 are needed");
}

// What changes along the trace of the radius, or of the position, must be more than rounding.
constexpr double kMostLengths = 1e6;

void require_usable_positions(const ProfileSource& source, const Profile& profile) {
  const double first = profile.positions.front(), last = profile.positions.back();
  const double reach = std::max(std::abs(first), std::abs(last)), length = last - first;
  if (profile.setup.kind == Kind::slide && reach > kMostLengths * length)
    throw DataError(source.path.string() + ": positions lie " + significant(reach, 3) +
                    " mm away from 0 over a length of " + significant(length, 3) +
                    " mm; accepted: up to a million times their length");
}

void require_usable_radius(const Setup& setup, double reach) {
  const double length = setup.last_mm - setup.first_mm;
  if (reach <= kMostLengths * length) return;
  throw KeyError("center_mm", "the spindle axis lies " + significant(reach, 3) +
                                  " mm away from a trace of " + significant(length, 3) +
                                  " mm; accepted: up to a million times its length");
}

// Of a radius, of which its drawing or its trace has four places.
constexpr double kRounding = 1e-4;

// The end of the trace that lies furthest from the spindle axis was cut, so the cut reached it.
void complete_cut_radius(Setup& setup) {
  if (setup.kind != Kind::face) return;
  const double reach = std::max(std::abs(setup.first_mm - setup.center_mm),
                                std::abs(setup.last_mm - setup.center_mm));
  require_usable_radius(setup, reach);
  const double declared = setup.cut_radius_mm.value_or(reach);
  if (declared < reach * (1.0 - kRounding))
    throw KeyError("cut_radius_mm",
                   shortest(declared) + ", but the trace reaches r = " + significant(reach, 9) +
                       "; give the outer radius of the cut, the right center_mm, or a window");
  setup.cut_radius_mm = std::max(declared, reach);
}

// "3, 120 to 122 and 5 more" of ascending rows.
std::string in_words(const std::vector<std::size_t>& rows) {
  constexpr std::size_t kNamed = 5;  // stretches
  std::vector<std::string> named;
  std::size_t first = 0;
  while (first < rows.size() && named.size() < kNamed) {
    std::size_t last = first;
    while (last + 1 < rows.size() && rows[last + 1] == rows[last] + 1) ++last;
    named.push_back(std::to_string(rows[first]) +
                    (last > first ? " to " + std::to_string(rows[last]) : ""));
    first = last + 1;
  }
  return joined(named) +
         (first < rows.size() ? " and " + std::to_string(rows.size() - first) + " more" : "");
}

void note_outliers(const ProfileSource& source, Profile& profile) {
  const std::size_t count = profile.outliers.size();
  std::vector<std::size_t> rows;
  for (const OutlierRow& outlier : profile.outliers) rows.push_back(outlier.row);
  const auto size = [](const OutlierRow& a) { return std::abs(a.value - a.expected); };
  const OutlierRow& largest = *std::ranges::max_element(profile.outliers, {}, size);
  const auto in_unit = [&profile](double value) {
    return profile.setup.quantity == Quantity::height
               ? significant(value / kMicrometre, 4) + " \u00b5m"
               : significant(value * 1e6, 4) + " \u00b5rad";
  };
  profile.notes.push_back(
      std::to_string(count) + (count == 1 ? " sample" : " samples") +
      " that neighbours contradict, " + (source.leave_out_spikes ? "left out" : "kept") +
      ": data row" + (count == 1 ? " " : "s ") + in_words(rows) +
      (count == 1 ? ", " : "; the largest in row " + std::to_string(largest.row) + ", ") +
      in_unit(largest.value) + " where " + in_unit(largest.expected) + " would fit" +
      (largest.kind == OutlierKind::lost_minus_sign ? ": a lost minus sign?" : ""));
}

void list_outliers(const ProfileSource& source, const Intake& intake, Profile& profile) {
  const std::vector<Outlier> outliers = find_outliers(profile.positions, profile.values);
  if (outliers.empty()) return;
  for (const Outlier& each : outliers)
    profile.outliers.push_back({intake.row(each.index), each.value, each.expected, each.kind});
  std::ranges::sort(profile.outliers, {}, &OutlierRow::row);
  note_outliers(source, profile);
  if (!source.leave_out_spikes) return;
  for (const Outlier& each : outliers) profile.values[each.index] = NAN;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < profile.values.size(); ++i) {
    if (std::isnan(profile.values[i])) continue;
    profile.positions[kept] = profile.positions[i];
    profile.values[kept++] = profile.values[i];
  }
  profile.positions.resize(kept);
  profile.values.resize(kept);
  profile.left_out += outliers.size();
}

std::string_view bytes_of(const std::vector<double>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double)};
}

void require_finite_positions(const std::vector<double>& positions) {
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!std::isfinite(positions[i]))
      throw DataError("data row " + std::to_string(i + 1) + ": the position is " +
                      shortest(positions[i]) + "; accepted: a finite number");
}

void complete(const ProfileSource& source, TraceFile file, Intake& intake, Profile& profile) {
  profile.format = std::move(file.format);
  profile.sha256 = std::move(file.sha256);
  if (!file.trace.decisions.empty())
    profile.notes.push_back(profile.format + ": " + joined(file.trace.decisions, "; "));
  intake.finish();
  require_two_samples(source, profile.positions.size());
  if (profile.line) std::tie(profile.line->first_mm, profile.line->last_mm) = intake.reach();
  list_outliers(source, intake, profile);
  require_usable_positions(source, profile);
  note_implausible_values(profile);
  complete_setup(profile);
}

}  // namespace

void complete_setup(Profile& profile) {
  profile.setup.first_mm = profile.positions.front();
  profile.setup.last_mm = profile.positions.back();
  complete_cut_radius(profile.setup);
  note_implausible_setup(profile);
}

std::vector<std::vector<std::string>> by_instrument(const std::vector<const Profile*>& profiles) {
  std::vector<std::vector<std::string>> out;
  std::vector<const Profile*> first;
  const auto is_one = [](const Profile& a, const Profile& b) {
    return a.instrument == b.instrument && a.setup.quantity == b.setup.quantity &&
           (a.instrument || a.setup.kind == b.setup.kind);
  };
  for (const Profile* profile : profiles) {
    const auto at =
        std::ranges::find_if(first, [&](const Profile* other) { return is_one(*profile, *other); });
    if (at == first.end()) {
      first.push_back(profile);
      out.push_back({profile->name});
    } else {
      out[static_cast<std::size_t>(at - first.begin())].push_back(profile->name);
    }
  }
  return out;
}

void read_profile(const ProfileSource& source, Profile& profile, const ReadProgress& progress) {
  Intake intake(source, profile);
  TraceFile file = read_trace(source.path, source.request, [&](const TracePart& part) {
    intake.take(part);
    if (progress) progress(part.share);
  });
  complete(source, std::move(file), intake, profile);
}

void take_profile(const ProfileSource& source, const Trace& numbers, Profile& profile) {
  constexpr const char* kArrays = "arrays";
  const std::vector<double>&positions = numbers.positions, &values = numbers.values;
  if (positions.size() != values.size())
    throw DataError(std::to_string(positions.size()) + " positions and " +
                    std::to_string(values.size()) + " values; accepted: as many");
  const bool timed = !source.request.time_column.empty();
  const std::size_t times = timed ? positions.size() : 0;
  if (numbers.times.size() != times)
    throw DataError(std::to_string(numbers.times.size()) + " reading times, " +
                    (timed ? "with" : "without") +
                    " a time_column; accepted: " + std::to_string(times));
  require_finite_positions(positions);
  ProfileSource named = source;
  named.path = kArrays;
  profile.file = kArrays;
  Intake intake(named, profile);
  try {
    intake.take({numbers.position_unit, numbers.value_unit, false, positions, values, 1.0,
                 timed ? std::span(numbers.times) : std::span<const double>{}});
  } catch (const DataError& error) {
    throw DataError(std::string(kArrays) + ": " + error.what());
  }
  std::string bytes = std::string(bytes_of(positions)).append(bytes_of(values));
  if (timed) bytes.append(bytes_of(numbers.times));
  std::string sum = sha256(bytes);
  complete(named, {kArrays, false, std::move(sum), {.decisions = numbers.decisions}}, intake,
           profile);
}

}  // namespace slideway
