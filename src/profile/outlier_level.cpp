#include "outlier_level.hpp"

#include <algorithm>
#include <functional>

#include "slideway/base/parallel.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

constexpr std::size_t kNear = 32;       // errors on either side
constexpr std::size_t kWindow = 16;     // values that make one peak
constexpr std::size_t kLonely = 4;      // peaks that may be half as large, or ...
constexpr std::size_t kPerPeak = 1000;  // ... one in so many values
constexpr double kGolden = 0.6180339887498949;

// By how much a limit rises where the scale is the MAD of so few errors: what holds kFalseAlarm in
// simulations of 10 to 63 white samples. Correlated ones need less.
double few_factor(std::size_t count) {
  const auto m = static_cast<double>(count);
  return 1.0 + 16.0 / m * (1.0 + 65.0 / (m * m));
}

}  // namespace

bool Level::judged(std::size_t i) const {
  if (uniform) return true;
  for (std::size_t j = i - outermost() + 1; j <= i + outermost(); ++j)
    if (positions[j] - positions[j - 1] > widest) return false;
  return true;
}

double Level::uneven_error(std::size_t i) const {
  const double *z = values.data() + i, *s = positions.data() + i;
  const auto d = static_cast<std::ptrdiff_t>(lag);
  const auto meet = [s](std::ptrdiff_t a, double at_a, std::ptrdiff_t b, double at_b) {
    return (at_a * (s[b] - s[0]) - at_b * (s[a] - s[0])) / (s[b] - s[a]);
  };
  const double inner = meet(-d, z[-d], d, z[d]);
  if (!cubic) return z[0] - inner;
  // Neville's scheme
  const double left = meet(-2 * d, z[-2 * d], -d, z[-d]), right = meet(d, z[d], 2 * d, z[2 * d]);
  const double before = meet(-2 * d, left, d, inner), after = meet(-d, inner, 2 * d, right);
  return z[0] - meet(-2 * d, before, 2 * d, after);
}

void Level::find_scale() {
  find_scale(values.size(), [this](std::size_t i) { return error(i); });
}

// The middle of all errors, and their scale.
void Level::find_scale(std::size_t size, const std::function<double(std::size_t)>& error_of) {
  const std::size_t first = outermost(), count = size - 2 * first;
  const std::size_t take = std::min(count, kScaleFrom);
  std::vector<double> part;
  double along = 0.0;
  for (std::size_t k = 0; k < take; ++k) {
    // By the golden section: every so many-th might keep step with the feed.
    along += along + kGolden < 1.0 ? kGolden : kGolden - 1.0;
    const std::size_t i =
        first + (take == count ? k : static_cast<std::size_t>(along * static_cast<double>(count)));
    if (judged(i)) part.push_back(error_of(i));
  }
  if (!cubic && !part.empty()) middle = median(part);  // the curvature of the whole
  for (double& each : part) each -= middle;
  scale = scale_of(part);
}

void Level::find_errors() {
  const std::size_t first = outermost(), last = values.size() - first;
  errors.assign(values.size(), 0.0);
  if (uniform)
    for (std::size_t i = first; i < last; ++i) errors[i] = even_error(i) - middle;
  else
    for (std::size_t i = first; i < last; ++i)
      if (judged(i)) errors[i] = uneven_error(i) - middle;
}

// How many errors are larger, of even steps.
std::uint64_t Level::count_above(double least, std::size_t from, std::size_t to) const {
  const auto d = static_cast<std::ptrdiff_t>(lag);
  const double* const z = values.data();
  const auto count_of = [&, about = middle](auto&& error_at) {
    std::uint64_t count = 0;
    for (std::size_t i = from; i < to; ++i) count += std::abs(error_at(z + i, d) - about) > least;
    return count;
  };
  std::uint64_t count = 0;
  wide([&] { count = cubic ? count_of(cubic_error) : count_of(linear_error); });
  return count;
}

// Whether any error is larger.
bool Level::any_above(double least) const {
  const std::size_t first = outermost(), last = values.size() - first;
  std::vector<char> above(parts_of(last - first, kPart));
  parallel_parts(last - first, kPart, [&](std::size_t part, std::size_t begin, std::size_t end) {
    const std::size_t from = first + begin, to = first + end;
    std::uint64_t count = 0;
    if (uniform)
      count = count_above(least, from, to);
    else
      for (std::size_t i = from; i < to; ++i)
        count += judged(i) && std::abs(uneven_error(i) - middle) > least;
    above[part] = count > 0;
  });
  return std::ranges::find(above, 1) != above.end();
}

// The standard deviation of normal errors by their MAD, which rounding may make too small.
double Level::scale_of(std::vector<double>& part) const {
  for (double& error : part) error = std::abs(error);
  return (part.empty() ? 0.0 : kMad * median(part)) + rounding;
}

// The scale beside a value, or if that is larger, of all errors. Of a short profile that of all
// errors it does not touch, larger by what the median of so few may be too small, and such that
// `limit` times it is twice what recurs.
double Level::scale_at(std::size_t i, double limit) const {
  const std::size_t first = outermost(), last = values.size() - first;
  const std::size_t left = std::max(first, i - std::min(i, touched()));
  const std::size_t right = std::min(last, i + touched() + 1);
  std::vector<double> part;
  const auto add = [&](std::size_t from, std::size_t to) {
    for (std::size_t j = from; j < to; ++j) part.push_back(errors[j]);
  };
  if (!cubic) {
    add(first, left);
    add(right, last);
    const double others = scale_of(part) * few_factor(part.size());
    // One other spike makes three large errors.
    if (part.size() <= 3) return INFINITY;
    std::ranges::nth_element(part, part.begin() + 3, std::greater<>());
    return std::max(others, 2.0 * part[3] / limit);
  }
  double out = scale * few_factor(values.size());
  if (left >= first + kNear) {
    add(left - kNear, left);
    out = std::max(out, scale_of(part));
    part.clear();
  }
  if (right + kNear <= last) {
    add(right, right + kNear);
    out = std::max(out, scale_of(part));
  }
  return out;
}

// What an error must be twice as large as: so many peaks may be larger.
double Level::peak_of_structure() const {
  if (!cubic) return 0.0;
  std::vector<double> peaks;
  for (std::size_t i = 0; i < errors.size(); i += kWindow) {
    double peak = 0.0;
    for (std::size_t j = i; j < std::min(i + kWindow, errors.size()); ++j)
      peak = std::max(peak, std::abs(errors[j]));
    peaks.push_back(peak);
  }
  const std::size_t lonely = std::max(kLonely, errors.size() / kPerPeak);
  if (lonely >= peaks.size()) return 0.0;
  std::ranges::nth_element(peaks, peaks.begin() + static_cast<std::ptrdiff_t>(lonely),
                           std::greater<>());
  return peaks[lonely];
}

bool Level::missed_from_either_side(std::size_t i, double error) const {
  const auto misses = [&](std::size_t near, std::size_t far) {
    const double slope = (values[near] - values[far]) / (position(near) - position(far));
    const double miss = values[i] - (values[near] + slope * (position(i) - position(near)));
    return miss * error > 0.0 && std::abs(miss) > 0.5 * std::abs(error);
  };
  return misses(i - lag, i - 2 * lag) && misses(i + lag, i + 2 * lag);
}

}  // namespace slideway
