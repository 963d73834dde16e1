#include "measured_log.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slideway/base/statistics.hpp"

namespace slideway {
namespace {

constexpr std::size_t kLeastReadings = 8;  // to tell noise from what moves
constexpr std::size_t kFinePlaces = 2000;  // of the quantity
constexpr double kMostBetween = 64.0;      // places between two readings
constexpr double kFalseAlarm = 1e-3;       // a log
constexpr double kNeighbours = 0.3;        // of an outlier, that they deviate to the other side
constexpr double kSecondDifference = 1.5;  // variance of a value less the mean of its neighbours
constexpr double kRareCode = 0.1;          // of the values
constexpr double kConstantRuns = 0.5;      // of the steps, where the resolution is coarse
constexpr double kOfRange = 1e-9;          // of the range

double range_of(const std::vector<double>& values) {
  const auto [low, high] = std::ranges::minmax(values);
  return high - low;
}

/// Smallest step between two neighbours that is none of rounding; 0: there is none.
double resolution_of(const std::vector<double>& values) {
  const double rounding = kOfRange * range_of(values);
  double least = INFINITY;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (const double step = std::abs(values[i] - values[i - 1]); step > rounding)
      least = std::min(least, step);
  return std::isfinite(least) ? least : 0.0;
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
  const std::vector<double> deviations = deviations_of(log);
  const double usual = std::max(deviation_of_most(deviations),
                                std::sqrt(kSecondDifference) * resolution_of(log.values));
  const double limit =
      std::sqrt(2.0 * std::log(static_cast<double>(deviations.size()) / kFalseAlarm)) * usual;
  for (std::size_t i = 1; i + 1 < deviations.size(); ++i) {
    const double own = std::abs(deviations[i]), sign = deviations[i] > 0.0 ? 1.0 : -1.0;
    const auto is_pulled = [&](std::size_t j) {
      return j == 0 || j + 1 == deviations.size() || -sign * deviations[j] > kNeighbours * own;
    };
    if (own > limit && is_pulled(i - 1) && is_pulled(i + 1)) out[i] = true;
  }
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
  return runs.values.size() >= kLeastReadings && steps < (1.0 - kConstantRuns) * all ? runs : out;
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
  if (!(deviation_of_most(deviations_of(quantity_)) > kOfRange * range_of(values))) return;
  trend_ = LocalTrend::of(at, values);
  const double finest = (log.at.back() - log.at.front()) / static_cast<double>(kFinePlaces);
  quantity_.at.clear();
  const auto add = [&](double place, double reading) {
    quantity_.at.push_back(place);
    readings_.push_back(reading);
  };
  if (log.at.front() < at.front()) add(log.at.front(), NAN);
  for (std::size_t i = 0; i < n; ++i) {
    add(at[i], values[i]);
    if (i + 1 == n) break;
    const double pieces = std::clamp(std::floor((at[i + 1] - at[i]) / finest), 1.0, kMostBetween);
    for (double k = 1.0; k < pieces; ++k) add(std::lerp(at[i], at[i + 1], k / pieces), NAN);
  }
  if (log.at.back() > at.back()) add(log.at.back(), NAN);
  quantity_.values = trend_.smoothed(quantity_.at, readings_);
}

Channel MeasuredLog::error(std::uint64_t seed) const {
  Channel out = quantity_;
  RandomStream random(seed, quantity_.name);
  if (trend_.noise > 0.0)
    out.values = trend_.error(quantity_.at, readings_, random);
  else
    std::ranges::fill(out.values, 0.0);
  return out;
}

}  // namespace slideway
