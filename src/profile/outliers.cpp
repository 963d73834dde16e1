#include "slideway/profile/outliers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "outlier_level.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/base/wide.hpp"
#include "slideway/signal/low_band.hpp"

namespace slideway {
namespace {

constexpr double kFalseAlarm = 1e-3;  // per profile
constexpr std::size_t kLeast = 10;    // samples
constexpr std::size_t kShort = 64;    // samples; fewer are held against second differences
constexpr int kCoarsest = 4;          // means of 2^4 samples
constexpr double kUniform = 1e-3;     // of the mean step
constexpr double kGain = 1.4;         // of rounding in a prediction error

// Pairs of means as the next means.
void halve(std::vector<double>& means) {
  for (std::size_t j = 0; 2 * j + 1 < means.size(); ++j)
    means[j] = 0.5 * (means[2 * j] + means[2 * j + 1]);
  means.resize(means.size() / 2);
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

// Means of 2^halvings samples, and how far away their neighbours are.
struct Resolution {
  int halvings = 0;
  std::size_t lag = 1;
};

// A level, and what an error must be larger than.
struct Threshold {
  Level level;
  double least = 0.0;
};

class Search {
 public:
  Search(std::span<const double> positions, std::span<const double> values);
  // Coarse first.
  [[nodiscard]] std::vector<Resolution> resolutions() const;
  // Whether no resolution has a candidate, in one reading and without memory for means. Only of
  // profiles of even steps that are not short; false of others.
  [[nodiscard]] bool nothing_stands_out() const;
  void search_at(const Resolution& resolution);
  [[nodiscard]] bool is_short() const { return values_.size() < kShort; }
  [[nodiscard]] std::size_t size() const { return values_.size(); }
  [[nodiscard]] std::vector<Outlier> found() const;

 private:
  [[nodiscard]] Level level_of(int halvings) const;
  void fill_level(int halvings);
  // For the errors of all levels.
  [[nodiscard]] double limit_of_errors() const {
    return limit_of(3.0 * static_cast<double>(size()));
  }
  [[nodiscard]] bool any_above(std::vector<Threshold>& thresholds, std::size_t first,
                               std::size_t last, std::vector<double>& means) const;
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

// Of samples first to last and those before them, in lanes that know nothing of one another.
Extremes extremes_of(const double* positions, const double* values, std::size_t first,
                     std::size_t last) {
  using Lanes = std::array<double, 8>;
  Lanes least_step, largest_step, resolution, largest{};
  least_step.fill(INFINITY);
  largest_step.fill(-INFINITY);
  resolution.fill(INFINITY);
  const auto add = [&](std::size_t k, std::size_t i) {
    const double step = positions[i] - positions[i - 1];
    const double change = std::abs(values[i] - values[i - 1]);
    const double moved = change > 0.0 ? change : INFINITY;
    least_step[k] = std::min(least_step[k], step);
    largest_step[k] = std::max(largest_step[k], step);
    resolution[k] = std::min(resolution[k], moved);
    largest[k] = std::max(largest[k], std::abs(values[i]));
  };
  std::size_t i = first;
  for (; i + largest.size() <= last + 1; i += largest.size())
    for (std::size_t k = 0; k < largest.size(); ++k) add(k, i + k);
  for (; i <= last; ++i) add(0, i);
  return {std::ranges::min(least_step), std::ranges::max(largest_step),
          std::ranges::min(resolution), std::ranges::max(largest)};
}

Extremes extremes_of(std::span<const double> positions, std::span<const double> values) {
  const std::size_t n = values.size();
  std::vector<Extremes> parts(parts_of(n - 1, kPart));
  parallel_parts(n - 1, kPart, [&](std::size_t part, std::size_t first, std::size_t last) {
    wide([&] { parts[part] = extremes_of(positions.data(), values.data(), first + 1, last); });
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

std::vector<Resolution> Search::resolutions() const {
  std::vector<Resolution> out;
  for (int halvings = kCoarsest; halvings >= 0 && !is_short(); --halvings)
    if ((size() >> halvings) >= kShort) out.push_back({halvings, 2});
  out.push_back({0, 1});
  return out;
}

// Without values.
Level Search::level_of(int halvings) const {
  Level out;
  out.cubic = !is_short();
  out.uniform = uniform_;
  out.block = std::size_t{1} << halvings;
  const auto block = static_cast<double>(out.block);
  out.widest = kGapSteps * step_ * block;
  out.rounding = kGain * rounding_ / std::sqrt(block);
  out.samples = positions_;
  return out;
}

void Search::fill_level(int halvings) {
  level_ = level_of(halvings);
  level_.positions = positions_;
  level_.values = clean_;
  const std::size_t block = level_.block, n = size() / block;
  if (block == 1) return;
  level_positions_.resize(uniform_ ? 0 : n);
  level_values_.reserve(size() / 2);
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

bool Search::nothing_stands_out() const {
  constexpr std::size_t kChunk = 1 << 13;  // samples whose means stay in the cache
  if (!uniform_ || is_short()) return false;
  const double limit = limit_of_errors();
  std::vector<Threshold> thresholds;
  for (const Resolution& each : resolutions()) {
    Level level = level_of(each.halvings);
    level.lag = each.lag;
    level.find_scale(size() / level.block, [&](std::size_t i) {
      std::array<double, 5> means{};
      for (std::size_t k = 0; k < means.size(); ++k)
        means[k] = mean(values_, (i + (k * each.lag) - 2 * each.lag) * level.block, level.block);
      return Level::cubic_error(&means[2], 1);
    });
    thresholds.push_back({level, limit * level.scale});
  }
  std::vector<char> found(parts_of(size(), kPart));
  parallel_parts(size(), kPart, [&](std::size_t part, std::size_t first, std::size_t last) {
    std::vector<Threshold> own = thresholds;
    std::vector<double> means;
    for (std::size_t at = first; at < last && found[part] == 0; at += kChunk)
      found[part] = any_above(own, at, std::min(last, at + kChunk), means) ? 1 : 0;
  });
  return std::ranges::find(found, 1) == found.end();
}

// Whether a mean of samples first ... last - 1 stands out.
bool Search::any_above(std::vector<Threshold>& thresholds, std::size_t first, std::size_t last,
                       std::vector<double>& means) const {
  constexpr std::size_t kMargin = std::size_t{4} << kCoarsest;  // samples that judge the outermost
  const std::size_t from = first - std::min(first, kMargin), to = std::min(size(), last + kMargin);
  means.assign(values_.begin() + static_cast<std::ptrdiff_t>(from),
               values_.begin() + static_cast<std::ptrdiff_t>(to));
  for (std::size_t block = 1; block <= thresholds.front().level.block; block *= 2) {
    if (block > 1) halve(means);
    for (Threshold& each : thresholds) {
      if (each.level.block != block) continue;
      each.level.values = means;
      const std::size_t before = from / block, outermost = each.level.outermost();
      const std::size_t begin = std::max(first / block, outermost);
      const std::size_t end = std::min(last / block, size() / block - outermost);
      if (end > begin && each.level.count_above(each.least, begin - before, end - before) > 0)
        return true;
    }
  }
  return false;
}

void Search::search_at(const Resolution& resolution) {
  const auto [halvings, lag] = resolution;
  if (level_.values.size() != size() >> halvings) fill_level(halvings);
  level_.lag = lag;
  level_.find_scale();
  const double limit = limit_of_errors();
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
  if (search.nothing_stands_out()) return {};
  for (const Resolution& each : search.resolutions()) search.search_at(each);
  return search.found();
}

}  // namespace slideway
