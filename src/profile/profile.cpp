#include "slideway/profile/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"
#include "slideway/profile/given.hpp"

namespace slideway {
namespace {

/// mm or rad. Beyond it lie the marks some instruments write for a missing value (1e38).
constexpr double kLargest = 1e9;

[[noreturn]] void refuse_order(const std::string& file, std::size_t row, double now, double last) {
  throw DataError(file + ": data row " + std::to_string(row) + ": position " + shortest(now) +
                  " follows " + shortest(last) +
                  "; positions must strictly increase (or strictly decrease)");
}

// What turns numbers of the file into ours.
struct Conversion {
  UnitScale position, value;  // to mm, or s where positions are times; to mm or rad
  UnitScale to_mm;            // of a time
  std::optional<std::pair<double, double>> window;  // in the file's unit
};

// The unit of the file's numbers: as the file states, or as the source says and the file's header,
// if it has one, agrees.
std::string checked_unit(const std::string& in_file, const std::string& asked, bool file_states,
                         const std::string& key) {
  if (file_states) return in_file;
  if (asked.empty())
    throw UsageError(key + " is missing: only a file that states its units needs none");
  if (!in_file.empty() && in_file != asked)
    throw DataError("the header has the unit " + in_file + ", the problem " + key + " = \"" +
                    asked + "\"; accepted: the same");
  return asked;
}

UnitScale scale_of(const std::string& unit, bool slope) {
  const auto scale = slope ? slope_unit(unit) : length_unit(unit);
  if (!scale)
    throw DataError(
        "has values in '" + unit + "'; accepted for a " +
        (slope ? "slope: " + std::string(kSlopeUnits) : "height: " + std::string(kLengthUnits)));
  return *scale;
}

Conversion conversion(const ProfileSource& source, const TraceFile& file, const Profile& profile) {
  const Setup& setup = profile.setup;
  const std::string unit = checked_unit(file.trace.position_unit, source.position_unit,
                                        file.states_units, "position_unit");
  const std::string value_unit =
      checked_unit(file.trace.value_unit, source.value_unit, file.states_units, "value_unit");
  Conversion out{{}, scale_of(value_unit, setup.quantity == Quantity::slope), {}, source.window};
  if (source.position_unit == "s" && unit != "s")
    throw DataError("states positions in " + unit +
                    ", the problem position_unit = \"s\"; accepted: a length");
  if (unit != "s") {
    out.position = scale_of(unit, false);
  } else {
    if (!setup.feed_mm_per_min)
      throw UsageError("profile '" + profile.name +
                       "': positions in time need feed_mm_per_min to become mm");
    out.to_mm = {*setup.feed_mm_per_min, kMinute};
  }
  if (out.window && unit != source.position_unit) {
    const UnitScale asked = scale_of(source.position_unit, false);
    for (double* end : {&out.window->first, &out.window->second})
      *end = asked(*end) * out.position.divisor / out.position.factor;
  }
  return out;
}

// The data rows to leave out, ascending. A row may be named twice.
std::vector<std::size_t> marked_rows(const ProfileSource& source, const std::string& name,
                                     std::size_t rows) {
  std::vector<std::size_t> marked = source.left_out_rows;
  for (const std::size_t row : marked)
    if (row == 0 || row > rows)
      throw UsageError("profile '" + name + "': leave_out: data row " + std::to_string(row) +
                       " is not there; accepted: 1 to " + std::to_string(rows));
  std::ranges::sort(marked);
  return marked;
}

// The data row of each sample, as runs of rows that follow one another.
class DataRows {
 public:
  void add(std::size_t sample, std::size_t row, std::size_t count) {
    if (runs_.empty() || runs_.back().second + (sample - runs_.back().first) != row)
      runs_.emplace_back(sample, row);
    samples_ = sample + count;
  }
  void reverse() { reversed_ = true; }
  std::size_t operator[](std::size_t sample) const {
    if (reversed_) sample = samples_ - 1 - sample;
    const auto after = std::ranges::upper_bound(runs_, sample, {}, &Run::first);
    return std::prev(after)->second + (sample - std::prev(after)->first);
  }

 private:
  using Run = std::pair<std::size_t, std::size_t>;  // its first sample and that one's row
  std::vector<Run> runs_;
  std::size_t samples_ = 0;
  bool reversed_ = false;
};

// Samples converted together, as most are: none missing, outside the window or out of order.
class PlainSamples {
 public:
  static constexpr std::size_t kCount = 1024;

  // False if one of them is not plain.
  bool convert(const Conversion& convert, std::span<const double> positions,
               std::span<const double> values, double last, bool upwards) {
    double largest = 0.0, missing = 0.0;
    for (std::size_t i = 0; i < kCount; ++i) {
      positions_[i] = convert.to_mm(convert.position(positions[i]));
      values_[i] = convert.value(values[i]);
    }
    for (std::size_t i = 0; i < kCount; ++i) {
      largest = std::max({largest, std::abs(positions_[i]), std::abs(values_[i])});
      missing += values_[i] - values_[i];  // NaN if one is
    }
    const double sign = upwards ? 1.0 : -1.0;
    double least = sign * (positions_[0] - last);
    for (std::size_t i = 1; i < kCount; ++i)
      least = std::min(least, sign * (positions_[i] - positions_[i - 1]));
    return largest <= kLargest && least > 0.0 && missing == 0.0;
  }
  void write(double* positions, double* values) const {
    std::ranges::copy(positions_, positions);
    std::ranges::copy(values_, values);
  }

 private:
  std::array<double, kCount> positions_, values_;
};

// Keeps the samples inside the window that have a value and are not left out, in place and in our
// units. `rows` are their data rows. Returns whether they run upwards.
bool keep_window(const ProfileSource& source, const Conversion& convert, Profile& profile,
                 DataRows& rows) {
  const std::string file = source.path.string();
  const std::vector<std::size_t> left_out =
      marked_rows(source, profile.name, profile.positions.size());
  std::vector<double>& positions = profile.positions;
  std::vector<double>& values = profile.values;
  const bool may_be_plain = !convert.window && left_out.empty();
  PlainSamples plain;
  std::size_t kept = 0;
  bool upwards = true;
  double last = 0.0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (may_be_plain && i % PlainSamples::kCount == 0 && kept > 1 &&
        positions.size() - i >= PlainSamples::kCount &&
        plain.convert(convert, std::span(positions).subspan(i), std::span(values).subspan(i),
                      positions[kept - 1], upwards)) {
      last = positions[i + PlainSamples::kCount - 1];
      plain.write(&positions[kept], &values[kept]);
      rows.add(kept, i + 1, PlainSamples::kCount);
      kept += PlainSamples::kCount;
      i += PlainSamples::kCount - 1;
      continue;
    }
    const double given = positions[i];
    if (convert.window && !(given >= convert.window->first && given <= convert.window->second))
      continue;
    if (std::isnan(values[i])) {
      ++profile.missing;
      continue;
    }
    if (std::ranges::binary_search(left_out, i + 1)) {
      ++profile.left_out;
      continue;
    }
    const double position = convert.to_mm(convert.position(given));
    const double value = convert.value(values[i]);
    if (!(std::abs(position) <= kLargest && std::abs(value) <= kLargest))
      throw DataError(file + ": data row " + std::to_string(i + 1) +
                      ": too large for its unit; the largest accepted: 1e9 mm or rad");
    if (kept == 1) upwards = position > positions[0];
    if (kept > 0) {
      const double step = position - positions[kept - 1];
      if (upwards ? !(step > 0.0) : !(step < 0.0)) refuse_order(file, i + 1, given, last);
    }
    last = given;
    positions[kept] = position;
    values[kept] = value;
    rows.add(kept, i + 1, 1);
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

// Sizes that nobody turns or measures with: a unit or a digit is more likely wrong.
void note_blunders(Profile& profile) {
  const Setup& setup = profile.setup;
  const auto [low, high] = std::ranges::minmax(profile.values);
  constexpr double kLargestRange = 1.0, kLargestFeed = 10000.0, kLargestSpeed = 1e5;
  if (setup.quantity == Quantity::height && high - low > kLargestRange)
    profile.notes.push_back("heights range over " + significant(high - low, 3) +
                            " mm, more than 1 mm: is value_unit right?");
  if (setup.feed_mm_per_min.value_or(0.0) > kLargestFeed)
    profile.notes.push_back("feed_mm_per_min = " + shortest(*setup.feed_mm_per_min) +
                            " is more than 10 m/min: is it right?");
  if (setup.spindle_rpm.value_or(0.0) > kLargestSpeed)
    profile.notes.push_back("spindle_rpm = " + shortest(*setup.spindle_rpm) +
                            " is more than 100000: is it right?");
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

void list_outliers(const ProfileSource& source, const DataRows& rows, Profile& profile) {
  const std::vector<Outlier> outliers = find_outliers(profile.positions, profile.values);
  if (outliers.empty()) return;
  for (const Outlier& each : outliers)
    profile.outliers.push_back({rows[each.index], each.value, each.expected, each.kind});
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

Conversion named_conversion(const ProfileSource& source, const TraceFile& file,
                            const Profile& profile) {
  try {
    return conversion(source, file, profile);
  } catch (const DataError& error) {
    throw DataError(source.path.string() + ": " + error.what());
  }
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

void convert_profile(const ProfileSource& source, TraceFile file, Profile& profile) {
  const Conversion convert = named_conversion(source, file, profile);
  profile.format = std::move(file.format);
  profile.sha256 = std::move(file.sha256);
  profile.positions = std::move(file.trace.positions);
  profile.values = std::move(file.trace.values);
  if (!file.trace.decisions.empty())
    profile.notes.push_back(profile.format + ": " + joined(file.trace.decisions, "; "));

  DataRows rows;
  const bool upwards = keep_window(source, convert, profile, rows);
  require_two_samples(source, profile.positions.size());
  if (profile.missing > 0)
    profile.notes.push_back(std::to_string(profile.missing) +
                            (profile.missing == 1 ? " missing point" : " missing points") +
                            " left out");
  if (profile.left_out > 0)
    profile.notes.push_back(std::to_string(profile.left_out) +
                            (profile.left_out == 1 ? " sample" : " samples") +
                            " left out by the problem's leave_out");
  if (!upwards) {
    rows.reverse();
    std::reverse(profile.positions.begin(), profile.positions.end());
    std::reverse(profile.values.begin(), profile.values.end());
    profile.notes.emplace_back("trace runs backwards in the file: reversed");
  }
  list_outliers(source, rows, profile);
  Setup& setup = profile.setup;
  setup.first_mm = profile.positions.front();
  setup.last_mm = profile.positions.back();
  complete_cut_radius(profile.name, setup);
  note_blunders(profile);
}

}  // namespace

void read_profile(const ProfileSource& source, Profile& profile) {
  convert_profile(source, read_trace(source.path, source.request), profile);
}

void take_profile(const ProfileSource& source, const Trace& numbers, Profile& profile) {
  constexpr const char* kArrays = "arrays";
  if (numbers.positions.size() != numbers.values.size())
    throw DataError(std::to_string(numbers.positions.size()) + " positions and " +
                    std::to_string(numbers.values.size()) + " values; accepted: as many");
  require_finite_positions(numbers.positions);
  ProfileSource named = source;
  named.path = kArrays;
  profile.file = kArrays;
  convert_profile(
      named,
      {kArrays, false,
       sha256(std::string(bytes_of(numbers.positions)).append(bytes_of(numbers.values))), numbers},
      profile);
}

}  // namespace slideway
