#include "slideway/profile/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace slideway {
namespace {

constexpr double kFalseAlarm = 1e-3;        // per profile
constexpr std::size_t kLeast = 10;          // samples
constexpr std::size_t kShort = 64;          // samples; fewer are held against second differences
constexpr int kCoarsest = 4;                // means of 2^4 samples
constexpr std::size_t kNear = 32;           // errors on either side
constexpr std::size_t kScaleFrom = 2048;    // errors: the scale of more is that of a part of them
constexpr std::size_t kWindow = 16;         // values that make one peak
constexpr std::size_t kLonely = 4;          // peaks that may be half as large, or ...
constexpr std::size_t kPerPeak = 1000;      // ... one in so many values
constexpr double kUniform = 1e-3;           // of the mean step
constexpr double kGap = 1.9;                // steps
constexpr double kMad = 1.482602218505602;  // of a normal distribution
constexpr double kGolden = 0.6180339887498949;
constexpr double kGain = 1.4;  // of rounding in a prediction error

double median(std::vector<double>& values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

double mean(std::span<const double> values, std::size_t first, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = first; i < first + count; ++i) sum += values[i];
  return sum / static_cast<double>(count);
}

// Of `count` normal errors one is larger in kFalseAlarm of all profiles at most (Mills' ratio).
double limit_of(double count) {
  double z = 4.0;
  for (int i = 0; i < 4; ++i)
    z = std::sqrt(2.0 * std::log(2.0 * count / (kFalseAlarm * std::sqrt(2.0 * M_PI) * z)));
  return z;
}

// By how much a limit rises where the scale is the MAD of so few errors: what holds kFalseAlarm in
// simulations of 10 to 63 white samples. Correlated ones need less.
double few_factor(std::size_t count) {
  const auto m = static_cast<double>(count);
  return 1.0 + 16.0 / m * (1.0 + 65.0 / (m * m));
}

// A profile or its means, and how a value follows from its neighbours: from those `lag` to either
// side (second difference), or by a cubic from those 2 lag away as well (fourth difference).
struct Level {
  std::vector<double> positions, values;
  std::size_t lag = 1;
  bool cubic = true;
  bool uniform = true;
  double widest = 0.0;  // step that is no gap

  std::vector<double> errors;  // about their median; 0 where not judged
  double middle = 0.0, scale = 0.0;
  double rounding = 0.0;  // standard deviation of what rounding makes of an error

  [[nodiscard]] std::size_t outermost() const { return cubic ? 2 * lag : lag; }
  // Errors that far away know nothing of a value and its next ones.
  [[nodiscard]] std::size_t touched() const { return cubic ? 3 * lag - 1 : lag; }
  [[nodiscard]] bool judged(std::size_t i) const;
  [[nodiscard]] double error(std::size_t i) const {
    return uniform ? even_error(i) : uneven_error(i);
  }
  [[nodiscard]] double even_error(std::size_t i) const {
    const double* z = values.data() + i;
    const auto d = static_cast<std::ptrdiff_t>(lag);
    return cubic ? z[0] - (2.0 / 3.0) * (z[-d] + z[d]) + (1.0 / 6.0) * (z[-2 * d] + z[2 * d])
                 : z[0] - 0.5 * (z[-d] + z[d]);
  }
  [[nodiscard]] double uneven_error(std::size_t i) const;
  void find_scale();
  void find_errors();
  [[nodiscard]] double scale_of(std::vector<double>& part) const;
  [[nodiscard]] double scale_at(std::size_t i, double limit) const;
  [[nodiscard]] double peak_of_structure() const;
  [[nodiscard]] bool missed_from_either_side(std::size_t i, double error) const;
};

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

// The middle of all errors, and their scale.
void Level::find_scale() {
  const std::size_t first = outermost(), count = values.size() - 2 * first;
  const std::size_t take = std::min(count, kScaleFrom);
  std::vector<double> part;
  double along = 0.0;
  for (std::size_t k = 0; k < take; ++k) {
    // By the golden section: every so many-th might keep step with the feed.
    along += along + kGolden < 1.0 ? kGolden : kGolden - 1.0;
    const std::size_t i =
        first + (take == count ? k : static_cast<std::size_t>(along * static_cast<double>(count)));
    if (judged(i)) part.push_back(error(i));
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
    const double slope = (values[near] - values[far]) / (positions[near] - positions[far]);
    const double miss = values[i] - (values[near] + slope * (positions[i] - positions[near]));
    return miss * error > 0.0 && std::abs(miss) > 0.5 * std::abs(error);
  };
  return misses(i - lag, i - 2 * lag) && misses(i + lag, i + 2 * lag);
}

class Search {
 public:
  Search(std::span<const double> positions, std::span<const double> values);
  void look(int halvings, std::size_t lag);
  [[nodiscard]] bool is_short() const { return values_.size() < kShort; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] std::vector<Outlier> found() const;

 private:
  void fill_level(int halvings);
  void take_out(int halvings, std::size_t i, double error);
  [[nodiscard]] double between(std::size_t left, std::size_t right, std::size_t i) const;

  std::span<const double> positions_, values_;
  std::vector<double> clean_;  // values; what was found, as expected
  std::vector<char> found_;
  Level level_;  // the one looked at
  bool uniform_ = true;
  double step_ = 0.0;      // median
  double rounding_ = 0.0;  // standard deviation of a value's rounding
  double scale_ = 0.0;     // of the error of one sample
};

Search::Search(std::span<const double> positions, std::span<const double> values)
    : positions_(positions),
      values_(values),
      clean_(values.begin(), values.end()),
      found_(values.size(), 0) {
  const std::size_t n = values.size();
  const double mean = (positions[n - 1] - positions[0]) / static_cast<double>(n - 1);
  double resolution = INFINITY, largest = 0.0, off = 0.0;
  for (std::size_t i = 1; i < n; ++i) {
    off = std::max(off, std::abs(positions[i] - positions[i - 1] - mean));
    const double change = std::abs(values[i] - values[i - 1]);
    resolution = change > 0.0 ? std::min(resolution, change) : resolution;
    largest = std::max(largest, std::abs(values[i]));
  }
  uniform_ = off <= kUniform * mean;
  rounding_ = 1e-12 * largest;
  if (std::isfinite(resolution)) rounding_ = std::max(rounding_, resolution / std::sqrt(12.0));
  std::vector<double> steps;
  for (std::size_t i = 1; i < n; i += 1 + n / kScaleFrom)
    steps.push_back(positions[i] - positions[i - 1]);
  step_ = median(steps);
  fill_level(0);
  level_.find_scale();
  scale_ = level_.scale;
}

void Search::fill_level(int halvings) {
  const std::size_t block = std::size_t{1} << halvings, n = size() / block;
  level_.cubic = !is_short();
  level_.uniform = uniform_;
  level_.widest = kGap * step_ * static_cast<double>(block);
  level_.rounding = kGain * rounding_ / std::sqrt(static_cast<double>(block));
  level_.positions.resize(n);
  level_.values.resize(n);
  for (std::size_t j = 0; j < n; ++j) {
    const double ends = positions_[j * block] + positions_[(j + 1) * block - 1];
    level_.positions[j] = uniform_ ? 0.5 * ends : mean(positions_, j * block, block);
    level_.values[j] = mean(clean_, j * block, block);
  }
}

void Search::look(int halvings, std::size_t lag) {
  if (level_.values.size() != size() >> halvings) fill_level(halvings);
  level_.lag = lag;
  level_.find_scale();
  level_.find_errors();
  const double limit = limit_of(3.0 * static_cast<double>(size()));  // errors of all levels
  const double least = is_short() ? 0.0 : limit * level_.scale;
  std::vector<std::size_t> candidates;
  for (std::size_t i = 2 * lag; i + 2 * lag < level_.errors.size(); ++i)
    if (std::abs(level_.errors[i]) > least) candidates.push_back(i);
  if (candidates.empty()) return;
  std::ranges::stable_sort(candidates, std::greater<>(),
                           [&](std::size_t i) { return std::abs(level_.errors[i]); });
  const double structure = 2.0 * level_.peak_of_structure();
  for (const std::size_t i : candidates) {
    if (std::abs(level_.errors[i]) <= structure) break;
    const double error = level_.error(i) - level_.middle;  // now that larger ones are taken out
    if (std::abs(error) > std::max(structure, limit * level_.scale_at(i, limit)) &&
        level_.missed_from_either_side(i, error))
      take_out(halvings, i, error);
  }
}

double Search::between(std::size_t left, std::size_t right, std::size_t i) const {
  const double along = (positions_[i] - positions_[left]) / (positions_[right] - positions_[left]);
  return (1.0 - along) * clean_[left] + along * clean_[right];
}

// The run of samples around the largest deviation under the means i - lag + 1 to i + lag - 1 that
// deviate by a quarter of it and by more than noise.
void Search::take_out(int halvings, std::size_t i, double error) {
  const std::size_t block = std::size_t{1} << halvings;
  const std::size_t from = (i - level_.lag + 1) * block, to = (i + level_.lag) * block;
  const double left = level_.positions[i - level_.lag], right = level_.positions[i + level_.lag];
  const auto deviation = [&](std::size_t k) {
    const double along = (positions_[k] - left) / (right - left);
    const double expected =
        (1.0 - along) * level_.values[i - level_.lag] + along * level_.values[i + level_.lag];
    return std::copysign(1.0, error) * (clean_[k] - expected);
  };
  std::size_t peak = from;
  for (std::size_t k = from; k < to; ++k)
    if (deviation(k) > deviation(peak)) peak = k;
  const double least = std::max(0.25 * deviation(peak), 3.0 * scale_);
  std::size_t first = peak, last = peak;
  while (first > from && deviation(first - 1) > least) --first;
  while (last + 1 < to && deviation(last + 1) > least) ++last;
  for (std::size_t k = first; k <= last; ++k) found_[k] = 1;
  for (std::size_t k = first; k <= last; ++k) clean_[k] = between(first - 1, last + 1, k);
  for (std::size_t j = first / block; j <= last / block; ++j)
    level_.values[j] = mean(clean_, j * block, block);
}

std::vector<Outlier> Search::found() const {
  std::vector<Outlier> out;
  for (std::size_t first = 0, last = 0; first < size(); first = last + 1) {
    last = first;
    if (found_[first] == 0) continue;
    while (found_[last + 1] != 0) ++last;
    for (std::size_t i = first; i <= last; ++i) {
      const double value = values_[i], expected = between(first - 1, last + 1, i);
      out.push_back({i, value, expected, std::abs(value - expected) / scale_});
      if (first == last && std::abs(-value - expected) < 3.0 * scale_)
        out.back().kind = OutlierKind::lost_minus_sign;
    }
  }
  return out;
}

}  // namespace

std::string_view name(OutlierKind kind) {
  return kind == OutlierKind::spike ? "spike" : "lost minus sign";
}

std::vector<Outlier> find_outliers(std::span<const double> positions,
                                   std::span<const double> values) {
  if (values.size() < kLeast) return {};
  Search search(positions, values);
  if (!search.is_short()) {
    for (int halvings = kCoarsest; halvings > 0; --halvings)
      if ((search.size() >> halvings) >= kShort) search.look(halvings, 2);
    search.look(0, 2);
  }
  search.look(0, 1);
  return search.found();
}

}  // namespace slideway
