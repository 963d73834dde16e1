#include "measured_log.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "slideway/base/statistics.hpp"
#include "slideway/profile/outliers.hpp"

namespace slideway {
namespace {

constexpr std::size_t kDraws = 64;         // a variance is known to (2 / 64)^½, U to a tenth
constexpr std::size_t kLeastReadings = 8;  // to tell noise from what moves
constexpr std::size_t kFinePlaces = 2000;  // of the quantity
constexpr double kMostBetween = 64.0;      // places between two readings
constexpr double kRareCode = 0.1;          // of the values
constexpr double kConstantRuns = 0.5;      // of the steps, where the resolution is coarse
constexpr double kOfRange = 1e-9;          // of the range
constexpr int kJumpWaves = 5;    // of when it jumps: they hold nine tenths of its variance
constexpr int kJumpPlaces = 16;  // between the readings
constexpr double kEdge = 1e-3;   // of the time between the readings

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return high - low;
}

/// Each value less the straight line between its neighbours; 0 at the ends.
std::vector<double> deviations_of(const Channel& log) {
  std::vector<double> out(log.values.size(), 0.0);
  for (std::size_t i = 1; i + 1 < out.size(); ++i) {
    const double share = (log.at[i] - log.at[i - 1]) / (log.at[i + 1] - log.at[i - 1]);
    out[i] = log.values[i] - std::lerp(log.values[i - 1], log.values[i + 1], share);
  }
  return out;
}

void add_single_ones(const Channel& log, std::vector<bool>& out) {
  const std::vector<Outlier> found = find_outliers(log.at, log.values);
  const auto is_found = [&](std::size_t index) {
    return std::ranges::binary_search(found, index, {}, &Outlier::index);
  };
  for (const Outlier& each : found)
    if (!is_found(each.index - 1) && !is_found(each.index + 1)) out[each.index] = true;
}

/// The rare values of one number at one end of the sorted ones, further away from the rest than the
/// rest's range.
void add_codes(const Channel& log, std::vector<bool>& out) {
  std::vector<double> sorted;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (!out[i]) sorted.push_back(log.values[i]);
  std::ranges::sort(sorted);
  const double most = kRareCode * static_cast<double>(sorted.size());
  const auto leave_out = [&](double number) {
    for (std::size_t i = 0; i < out.size(); ++i)
      if (log.values[i] == number) out[i] = true;
  };
  const auto low =
      static_cast<std::size_t>(std::ranges::upper_bound(sorted, sorted.front()) - sorted.begin());
  const auto high =
      static_cast<std::size_t>(std::ranges::lower_bound(sorted, sorted.back()) - sorted.begin());
  if (low >= high) return;
  if (static_cast<double>(low) <= most &&
      sorted[low] - sorted.front() > sorted.back() - sorted[low])
    return leave_out(sorted.front());
  if (static_cast<double>(sorted.size() - high) <= most &&
      sorted.back() - sorted[high - 1] > sorted[high - 1] - sorted.front())
    leave_out(sorted.back());
}

/// The log without its outliers; runs of one value as one in their middle if they are the rule.
Channel readings_of(const Channel& log) {
  Channel out = log;
  const std::vector<std::size_t> outliers = outliers_of(log);
  for (std::size_t k = outliers.size(); k-- > 0;) {
    out.at.erase(out.at.begin() + static_cast<std::ptrdiff_t>(outliers[k]));
    out.values.erase(out.values.begin() + static_cast<std::ptrdiff_t>(outliers[k]));
  }
  Channel runs = out;
  runs.at.clear();
  runs.values.clear();
  for (std::size_t first = 0, last = 0; first < out.values.size(); first = last + 1) {
    last = first;
    while (last + 1 < out.values.size() && out.values[last + 1] == out.values[first]) ++last;
    runs.at.push_back(0.5 * (out.at[first] + out.at[last]));
    runs.values.push_back(out.values[first]);
  }
  const auto steps = static_cast<double>(runs.values.size()),
             all = static_cast<double>(out.values.size());
  const auto [low, high] = std::ranges::minmax(out.values);
  const bool is_switch = std::ranges::all_of(
      out.values, [low = low, high = high](double value) { return value == low || value == high; });
  return !is_switch && runs.values.size() >= kLeastReadings && steps < (1.0 - kConstantRuns) * all
             ? runs
             : out;
}

}  // namespace

std::vector<std::size_t> outliers_of(const Channel& log) {
  std::vector<bool> is_outlier(log.values.size(), false);
  if (log.values.size() >= kLeastReadings) {
    add_single_ones(log, is_outlier);
    add_codes(log, is_outlier);
  }
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < is_outlier.size(); ++i)
    if (is_outlier[i]) out.push_back(i);
  return out;
}

MeasuredLog::MeasuredLog(const Channel& log) : quantity_(readings_of(log)) {
  const std::vector<double> at = quantity_.at, values = quantity_.values;
  const std::size_t n = values.size();
  if (n < kLeastReadings) return;
  const bool is_noisy = deviation_of_most(deviations_of(quantity_)) > kOfRange * range_of(values);
  if (is_noisy)
    trend_ = LocalTrend::of(at, values);
  else
    trend_.jumps = plain_jumps(at, values);
  if (!is_noisy && trend_.jumps.empty()) return;
  const double finest = (log.at.back() - log.at.front()) / static_cast<double>(kFinePlaces);
  quantity_.at.clear();
  quantity_.values.clear();
  const auto add = [&](double place, double reading, double straight) {
    quantity_.at.push_back(place);
    quantity_.values.push_back(straight);
    readings_.push_back(reading);
  };
  if (log.at.front() < at.front()) add(log.at.front(), NAN, values.front());
  for (std::size_t i = 0; i < n; ++i) {
    add(at[i], values[i], values[i]);
    if (i + 1 == n) break;
    double pieces = std::clamp(std::floor((at[i + 1] - at[i]) / finest), 1.0, kMostBetween);
    if (std::ranges::binary_search(trend_.jumps, at[i], {}, &LocalTrend::Jump::from))
      pieces = std::max<double>(pieces, kJumpPlaces);
    for (double k = 1.0; k < pieces; ++k)
      add(std::lerp(at[i], at[i + 1], k / pieces), NAN,
          std::lerp(values[i], values[i + 1], k / pieces));
  }
  if (log.at.back() > at.back()) add(log.at.back(), NAN, values.back());
  if (is_noisy) quantity_.values = trend_.smoothed(quantity_.at, readings_);
}

const std::vector<Channel>& MeasuredLog::errors() const {
  std::call_once(drawn_, [&] {
    if (trend_.noise > 0.0) add_draws();
    for (const LocalTrend::Jump& jump : trend_.jumps) add_times(jump);
  });
  return errors_;
}

void MeasuredLog::add_draws() const {
  for (std::size_t d = 0; d < kDraws; ++d) {
    RandomStream random(d, quantity_.name);
    std::vector<double>& values = errors_.emplace_back(quantity_).values;
    values = trend_.error(quantity_.at, readings_, random);
    for (double& each : values) each /= std::sqrt(static_cast<double>(kDraws));
  }
}

void MeasuredLog::add_times(const LocalTrend::Jump& jump) const {
  const auto value_at = [&](double place) {
    return quantity_.values[static_cast<std::size_t>(std::ranges::lower_bound(quantity_.at, place) -
                                                     quantity_.at.begin())];
  };
  const double size = value_at(jump.to) - value_at(jump.from), length = jump.to - jump.from;
  const auto add = [&](auto&& part) {
    Channel& error = errors_.emplace_back(quantity_);
    error.at = {jump.from - kEdge * length};
    error.values = {0.0};
    for (int i = 0; i <= kJumpPlaces; ++i) {
      const double share = static_cast<double>(i) / kJumpPlaces;
      error.at.push_back(std::lerp(jump.from, jump.to, share));
      error.values.push_back(size * part(share));
    }
    error.at.push_back(jump.to + kEdge * length);
    error.values.push_back(0.0);
  };
  add([](double) { return 1.0 / std::sqrt(12.0); });
  for (int wave = 2; wave <= kJumpWaves; ++wave) {
    const double turn = std::numbers::pi * wave;
    add([turn](double share) { return std::numbers::sqrt2 / turn * std::sin(turn * share); });
  }
}

}  // namespace slideway
