#include "slideway/profile/outliers.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "outlier_level.hpp"
#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

constexpr double kFalseAlarm = 1e-3;  // per profile
constexpr std::size_t kLeast = 10;    // samples
constexpr std::size_t kShort = 64;    // samples; fewer are held against second differences
constexpr int kCoarsest = 4;          // means of 2^4 samples
constexpr double kUniform = 1e-3;     // of the mean step
constexpr double kGap = 1.9;          // steps
constexpr double kGain = 1.4;         // of rounding in a prediction error

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
  std::span<const double> clean_;  // values; what was found, as expected
  std::vector<double> cleaned_;    // those, once something was found
  std::vector<char> found_;        // by sample; empty until then
  Level level_;                    // the one looked at
  std::vector<double> level_positions_, level_values_;
  bool uniform_ = true;
  double step_ = 0.0;      // median
  double rounding_ = 0.0;  // standard deviation of a value's rounding
  double scale_ = 0.0;     // of the error of one sample
};

// Smallest and largest steps and changes of a profile.
struct Extremes {
  double least_step = INFINITY, largest_step = -INFINITY;
  double resolution = INFINITY;  // smallest change of the values
  double largest = 0.0;          // value but the first
};

Extremes extremes_of(std::span<const double> positions, std::span<const double> values) {
  const std::size_t n = values.size();
  std::vector<Extremes> parts(parts_of(n - 1, kPart));
  parallel_parts(n - 1, kPart, [&](std::size_t part, std::size_t first, std::size_t last) {
    Extremes all;
    for (std::size_t i = first + 1; i < last + 1; ++i) {
      const double step = positions[i] - positions[i - 1];
      const double change = std::abs(values[i] - values[i - 1]);
      all.least_step = std::min(all.least_step, step);
      all.largest_step = std::max(all.largest_step, step);
      all.resolution = std::min(all.resolution, change > 0.0 ? change : INFINITY);
      all.largest = std::max(all.largest, std::abs(values[i]));
    }
    parts[part] = all;
  });
  Extremes out;
  for (const Extremes& part : parts)
    out = {std::min(out.least_step, part.least_step), std::max(out.largest_step, part.largest_step),
           std::min(out.resolution, part.resolution), std::max(out.largest, part.largest)};
  return out;
}

Search::Search(std::span<const double> positions, std::span<const double> values)
    : positions_(positions), values_(values), clean_(values) {
  const std::size_t n = values.size();
  const double mean = (positions[n - 1] - positions[0]) / static_cast<double>(n - 1);
  const Extremes extremes = extremes_of(positions, values);
  const double off =
      std::max(std::abs(extremes.least_step - mean), std::abs(extremes.largest_step - mean));
  uniform_ = off <= kUniform * mean;
  rounding_ = 1e-12 * extremes.largest;
  if (std::isfinite(extremes.resolution))
    rounding_ = std::max(rounding_, extremes.resolution / std::sqrt(12.0));
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
  level_.block = block;
  level_.widest = kGap * step_ * static_cast<double>(block);
  level_.rounding = kGain * rounding_ / std::sqrt(static_cast<double>(block));
  level_.samples = level_.positions = positions_;
  level_.values = clean_;
  if (block == 1) return;
  level_positions_.resize(uniform_ ? 0 : n);
  level_values_.resize(n);
  parallel_parts(n, kPart, [&](std::size_t /*part*/, std::size_t first, std::size_t last) {
    for (std::size_t j = first; j < last; ++j) {
      if (!uniform_) level_positions_[j] = mean(positions_, j * block, block);
      level_values_[j] = mean(clean_, j * block, block);
    }
  });
  level_.positions = level_positions_;
  level_.values = level_values_;
}

void Search::look(int halvings, std::size_t lag) {
  if (level_.values.size() != size() >> halvings) fill_level(halvings);
  level_.lag = lag;
  level_.find_scale();
  const double limit = limit_of(3.0 * static_cast<double>(size()));  // errors of all levels
  const double least = is_short() ? 0.0 : limit * level_.scale;
  if (!level_.any_above(least)) return;
  level_.find_errors();
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
  const double left = level_.position(i - level_.lag), right = level_.position(i + level_.lag);
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
  if (found_.empty()) {
    cleaned_.assign(values_.begin(), values_.end());
    clean_ = cleaned_;
    found_.resize(size());
    if (block == 1) level_.values = clean_;
  }
  for (std::size_t k = first; k <= last; ++k) found_[k] = 1;
  for (std::size_t k = first; k <= last; ++k) cleaned_[k] = between(first - 1, last + 1, k);
  for (std::size_t j = first / block; block > 1 && j <= last / block; ++j)
    level_values_[j] = mean(clean_, j * block, block);
}

std::vector<Outlier> Search::found() const {
  std::vector<Outlier> out;
  for (std::size_t first = 0, last = 0; first < found_.size(); first = last + 1) {
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
