#include "intake.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

// mm or rad. Beyond it lie the marks some instruments write for a missing value (1e38).
constexpr double kLargest = 1e9;
constexpr double kLongest = 1e12;  // s: Unix time has 1.7e9

// The unit of the file's numbers: as the file or its header states, and as the source says, which
// agrees with the header.
std::string checked_unit(const std::string& in_file, const std::string& asked, bool file_states,
                         const std::string& key) {
  if (file_states || (asked.empty() && !in_file.empty())) return in_file;
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

UnitScale time_scale(const ProfileSource& source, const std::string& in_file) {
  const auto scale = time_unit(checked_unit(in_file, source.time_unit, false, "time_unit"));
  if (!scale) throw UsageError("time_unit: accepted: " + std::string(kTimeUnits));
  return *scale;
}

Conversion conversion(const ProfileSource& source, const TracePart& part, const Profile& profile) {
  const Setup& setup = profile.setup;
  const std::string unit =
      checked_unit(part.position_unit, source.position_unit, part.states_units, "position_unit");
  const std::string value_unit =
      checked_unit(part.value_unit, source.value_unit, part.states_units, "value_unit");
  Conversion out;
  out.value = scale_of(value_unit, setup.quantity == Quantity::slope);
  out.window = source.window;
  out.mask = source.mask;
  if (!source.request.time_column.empty())
    out.time = time_scale(source, std::string(part.time_unit));
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
  if (unit == source.position_unit || !(out.window || !out.mask.empty())) return out;
  const UnitScale asked = scale_of(source.position_unit, false);
  const auto restate = [&](std::pair<double, double>& range) {
    for (double* end : {&range.first, &range.second})
      *end = asked(*end) * out.position.divisor / out.position.factor;
  };
  if (out.window) restate(*out.window);
  std::ranges::for_each(out.mask, restate);
  return out;
}

constexpr std::size_t kForResolution = 1024;  // readings that are looked at
constexpr double kMostSteps = 1e8;            // that an instrument has in the range of its readings
constexpr double kWhole = 1e-4;               // off a whole number: what changed units leave

/// The step of a digital indication: all values differ by whole multiples of it, whatever the unit
/// (their greatest common divisor by Euclid's algorithm, each remainder below kWhole taken as 0). 0
/// where they have more digits than an instrument shows.
double resolution_of(std::span<const double> values) {
  values = values.first(std::min(values.size(), kForResolution));
  if (values.empty()) return 0.0;
  const auto [low, high] = std::ranges::minmax(values);
  const double least = (high - low) / kMostSteps;
  double step = 0.0, longest = 0.0;  // the difference that tells the step in the most digits
  for (const double value : values) {
    double larger = value - low;
    if (step == 0.0) step = larger;
    while (step > 0.0) {
      const double multiples = std::round(larger / step);
      const double left = std::abs(larger - multiples * step);
      if (left <= kWhole * step) {
        if (larger > longest) {
          longest = larger;
          step = larger / multiples;
        }
        break;
      }
      if (left < least) return 0.0;
      larger = std::exchange(step, left);
      longest = left;
    }
  }
  return step;
}

}  // namespace

bool PlainSamples::convert(const Conversion& convert, std::span<const double> positions,
                           std::span<const double> values, double last, bool upwards) {
  const double sign = upwards ? 1.0 : -1.0;
  std::uint64_t plain = sign * (convert.to_mm(convert.position(positions[0])) - last) > 0.0;
  wide([&] {
    scaled(convert.position, positions.data(), positions_);
    scaled(convert.to_mm, positions_.data(), positions_);
    scaled(convert.value, values.data(), values_);
    for (const Samples* samples : {&positions_, &values_})
      for (const double sample : *samples)  // not a NaN, which stands for a missing value
        plain += std::abs(sample) <= kLargest;
    for (std::size_t i = 1; i < kCount; ++i)
      plain += sign * (positions_[i] - positions_[i - 1]) > 0.0;
  });
  return plain == 3 * kCount;
}

void PlainSamples::scaled(const UnitScale& scale, const double* from, Samples& to) {
  if (scale.factor == 1.0 && scale.divisor == 1.0) {
    if (from != to.data()) std::copy_n(from, kCount, to.begin());
  } else {
    for (std::size_t i = 0; i < kCount; ++i) to[i] = scale(from[i]);
  }
}

Intake::Intake(const ProfileSource& source, Profile& profile)
    : source_(&source), profile_(&profile), left_out_rows_(source.left_out_rows) {
  std::ranges::sort(left_out_rows_);
  profile.positions.clear();
  profile.values.clear();
}

void Intake::start(const TracePart& part) {
  convert_ = conversion(*source_, part, *profile_);
  const double expected = 1.02 * static_cast<double>(part.positions.size()) / part.share;
  const std::size_t room = expected < static_cast<double>(source_->most_samples)
                               ? static_cast<std::size_t>(expected) + 1
                               : source_->most_samples;
  profile_->positions.reserve(room);
  profile_->values.reserve(room);
  if (!source_->request.time_column.empty()) times_.reserve(room);
}

void Intake::take(const TracePart& part) {
  if (!convert_) start(part);
  const bool may_be_plain =
      !convert_->window && convert_->mask.empty() && left_out_rows_.empty() && part.times.empty();
  constexpr std::size_t kCount = PlainSamples::kCount;
  for (std::size_t i = 0; i < part.positions.size();) {
    if (may_be_plain && kept_ > 1 && part.positions.size() - i >= kCount &&
        plain_.convert(*convert_, part.positions.subspan(i), part.values.subspan(i), last_mm_,
                       upwards_)) {
      keep(plain_.positions(), plain_.values(), {}, rows_ + 1);
      i += kCount;
      rows_ += kCount;
      last_given_ = part.positions[i - 1];
    } else {
      ++rows_;
      take_one(part.positions[i], part.values[i],
               part.times.empty() ? part.times : part.times.subspan(i, 1));
      ++i;
    }
  }
}

void Intake::take_one(double given, double value_given, std::span<const double> time_given) {
  const auto refuse = [this](const std::string& what) {
    throw DataError("data row " + std::to_string(rows_) + ": " + what);
  };
  if (convert_->window && !(given >= convert_->window->first && given <= convert_->window->second))
    return;
  if (convert_->is_masked(given)) {
    ++masked_;
    return pass_over(given);
  }
  if (std::isnan(value_given)) {
    ++profile_->missing;
    return pass_over(given);
  }
  if (std::ranges::binary_search(left_out_rows_, rows_)) {
    ++profile_->left_out;
    return pass_over(given);
  }
  const double position = convert_->to_mm(convert_->position(given));
  const double value = convert_->value(value_given);
  if (!(std::abs(position) <= kLargest && std::abs(value) <= kLargest))
    refuse("too large for its unit; the largest accepted: 1e9 mm or rad");
  if (kept_ == 1) upwards_ = position > last_mm_;
  if (kept_ > 0 && !(upwards_ ? position > last_mm_ : position < last_mm_))
    refuse("position " + shortest(given) + " follows " + shortest(last_given_) +
           "; positions must strictly increase (or strictly decrease)");
  last_given_ = given;
  const double time = time_given.empty() ? 0.0 : convert_->time(time_given[0]);
  if (std::isnan(time)) refuse("no reading time; accepted: a finite number in the time column");
  if (!(std::abs(time) <= kLongest)) refuse("reading time beyond 1e12 s");
  keep({&position, 1}, {&value, 1}, {&time, time_given.size()}, rows_);
}

void Intake::pass_over(double given) {
  const double position = convert_->to_mm(convert_->position(given));
  if (!(std::abs(position) <= kLargest)) return;
  passed_over_.first = std::min(passed_over_.first, position);
  passed_over_.second = std::max(passed_over_.second, position);
}

std::pair<double, double> Intake::reach() const {
  return {std::min(passed_over_.first, profile_->positions.front()),
          std::max(passed_over_.second, profile_->positions.back())};
}

void Intake::keep(std::span<const double> positions, std::span<const double> values,
                  std::span<const double> times, std::size_t first_row) {
  if (runs_.empty() || runs_.back().second + (kept_ - runs_.back().first) != first_row)
    runs_.emplace_back(kept_, first_row);
  kept_ += positions.size();
  last_mm_ = positions.back();
  while (!positions.empty()) {
    if (profile_->positions.size() == source_->most_samples) halve();
    std::size_t count = 1;
    if (block_ == 1) {
      count = std::min(positions.size(), source_->most_samples - profile_->positions.size());
      const auto mm = positions.first(count), kept = values.first(count);
      profile_->positions.insert(profile_->positions.end(), mm.begin(), mm.end());
      profile_->values.insert(profile_->values.end(), kept.begin(), kept.end());
      times_.insert(times_.end(), times.begin(), times.end());
    } else {
      keep_mean(positions[0], values[0], times);
    }
    positions = positions.subspan(count);
    values = values.subspan(count);
  }
}

void Intake::keep_mean(double position, double value, std::span<const double> time) {
  position_sum_ += position;
  value_sum_ += value;
  for (const double each : time) time_sum_ += each;
  if (++pending_ < block_) return;
  profile_->positions.push_back(position_sum_ / static_cast<double>(block_));
  profile_->values.push_back(value_sum_ / static_cast<double>(block_));
  if (!time.empty()) times_.push_back(time_sum_ / static_cast<double>(block_));
  pending_ = 0;
  position_sum_ = value_sum_ = time_sum_ = 0.0;
}

void Intake::halve() {
  for (std::vector<double>* series : {&profile_->positions, &profile_->values, &times_}) {
    const std::size_t half = series->size() / 2;
    for (std::size_t i = 0; i < half; ++i)
      (*series)[i] = 0.5 * ((*series)[2 * i] + (*series)[2 * i + 1]);
    series->resize(half);
  }
  block_ *= 2;
}

void Intake::check_left_out() const {
  for (const std::size_t row : left_out_rows_)
    if (row == 0 || row > rows_)
      throw UsageError("profile '" + profile_->name + "': leave_out: data row " +
                       std::to_string(row) + " is not there; accepted: 1 to " +
                       std::to_string(rows_));
}

void Intake::finish() {
  check_left_out();
  std::vector<std::string>& notes = profile_->notes;
  if (profile_->missing > 0)
    notes.push_back(counted(profile_->missing, "missing point") + " left out");
  if (profile_->left_out > 0)
    notes.push_back(counted(profile_->left_out, "sample") + " left out by the problem's leave_out");
  if (masked_ > 0) notes.push_back(counted(masked_, "sample") + " left out by the problem's mask");
  profile_->left_out += masked_;
  if (block_ > 1) {
    notes.push_back(counted(kept_, "sample") + ", more than " +
                    std::to_string(source_->most_samples) + ": kept as means of " +
                    std::to_string(block_) + " each");
    if (profile_->standard_uncertainty)
      *profile_->standard_uncertainty /= std::sqrt(static_cast<double>(block_));
  }
  if (!upwards_) {
    for (std::vector<double>* series : {&profile_->positions, &profile_->values, &times_})
      std::ranges::reverse(*series);
    notes.emplace_back("trace runs backwards in the file: reversed");
  }
  if (block_ == 1 && convert_) profile_->resolution = resolution_of(profile_->values);
  if (!times_.empty())
    profile_->setup.reading_times =
        std::make_shared<const ReadingTimes>(ReadingTimes{profile_->positions, std::move(times_)});
}

std::size_t Intake::row(std::size_t sample) const {
  if (!upwards_) sample = profile_->positions.size() - 1 - sample;
  const std::size_t kept = sample * block_;
  const auto run = std::prev(std::ranges::upper_bound(runs_, kept, {}, &Run::first));
  return run->second + (kept - run->first);
}

}  // namespace slideway
