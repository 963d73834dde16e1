#include "slideway/signal/low_band.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "slideway/base/error.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

constexpr double kUniform = 1e-3;    // of the mean step
constexpr double kMostFilled = 4.0;  // grid points per sample; beyond it gaps are the rule

// Of the weight of a coefficient. Interpolated points vary less than readings, so half a gap does
// no harm; a reading that the extension repeats counts twice: a quarter makes the variance 1.5.
constexpr double kMostInGaps = 0.5, kMostBeyond = 0.25;

double mean_step(std::span<const double> positions) {
  return (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
}

void check_size(const LowBandOptions& options, std::size_t samples) {
  if (options.level < 0)
    throw UsageError("low band: level " + std::to_string(options.level) +
                     "; accepted: 0 or a positive number");
  const int largest = static_cast<int>(std::bit_width(samples)) - 1;
  if (options.level <= largest) return;
  if (samples == 0) throw DataError("low band: 0 samples; accepted: at least 1");
  const std::string least = options.level < 63 ? std::to_string(std::uint64_t{1} << options.level)
                                               : "2^" + std::to_string(options.level);
  throw DataError("low band: " + std::to_string(samples) + " samples, level " +
                  std::to_string(options.level) + " needs at least " + least +
                  "; accepted: level <= " + std::to_string(largest));
}

// Whether the steps are all the same. A trace that turns back or stands still has no grid.
bool is_uniform(std::span<const double> positions) {
  constexpr std::size_t kPart = 1 << 16;
  const double mean = mean_step(positions), most = kUniform * std::abs(mean);
  const std::size_t steps = positions.size() - 1;
  std::vector<char> uniform_part(parts_of(steps, kPart));
  parallel_parts(steps, kPart, [&](std::size_t part, std::size_t first, std::size_t last) {
    std::uint64_t uniform = 0;
    wide([&] {
      for (std::size_t i = first; i < last; ++i)
        uniform += std::abs(positions[i + 1] - positions[i] - mean) <= most;
    });
    uniform_part[part] = uniform == last - first;
  });
  if (mean != 0.0 && std::ranges::find(uniform_part, 0) == uniform_part.end()) return true;
  for (std::size_t i = 1; i < positions.size(); ++i) {
    const double step = positions[i] - positions[i - 1];
    if (!(step * mean > 0.0))
      throw DataError("low band: position " + shortest(positions[i]) + " mm of sample " +
                      std::to_string(i + 1) + " after " + shortest(positions[i - 1]) +
                      " mm; accepted: positions that only rise or only fall");
  }
  return false;
}

// Samples of the uniform grid: one per median step where every step is a multiple of that, so that
// only gaps are filled; else as many as there are.
Eigen::Index grid_size(std::span<const double> positions) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < positions.size(); ++i)
    steps.push_back(std::abs(positions[i] - positions[i - 1]));
  std::vector<double> sorted = steps;
  const double usual = median(sorted);
  double cells = 0.0;
  for (const double step : steps) {
    const double multiple = std::round(step / usual);
    if (!(std::abs(step - multiple * usual) <= kUniform * std::max(1.0, multiple) * usual))
      return std::ssize(positions);
    cells += multiple;
  }
  if (!(cells < kMostFilled * static_cast<double>(positions.size()))) return std::ssize(positions);
  return static_cast<Eigen::Index>(cells) + 1;
}

}  // namespace

// Room for the grid and each level, so that a matrix of columns allocates once.
struct LowBand::Workspace {
  std::vector<double> grid;
  std::vector<Band> levels;
};

LowBandOptions with_at_most(LowBandOptions options, std::size_t samples, std::size_t values) {
  while ((samples >> options.level) > values) ++options.level;
  return options;
}

LowBand::LowBand(const LowBandOptions& options, std::span<const double> positions)
    : wavelet_(daubechies(options.wavelet)),
      options_(options),
      samples_(std::ssize(positions)),
      values_(samples_) {
  check_size(options, positions.size());
  if (options.level == 0) return;
  const bool uniform = is_uniform(positions);
  if (!uniform) samples_ = grid_size(positions);
  values_ = samples_;
  for (int level = 0; level < options.level; ++level)
    values_ = static_cast<Eigen::Index>(
        dwt_length(static_cast<std::size_t>(values_), wavelet_.taps(), options.boundary));
  std::vector<char> is_unmeasured(static_cast<std::size_t>(values_), 0);
  find_beyond_ends(is_unmeasured);
  if (!uniform) find_in_gaps(lay_grid(positions), is_unmeasured);
  for (Eigen::Index j = 0; j < values_; ++j)
    if (is_unmeasured[static_cast<std::size_t>(j)] != 0) unmeasured_.push_back(j);
}

std::vector<double> LowBand::lay_grid(std::span<const double> positions) {
  const std::size_t n = positions.size();
  const double step =
      std::abs(positions.back() - positions.front()) / static_cast<double>(samples_ - 1);
  std::vector<double> inside_gaps(static_cast<std::size_t>(samples_), 0.0);
  std::size_t left = 0;
  for (std::size_t i = 0; i < inside_gaps.size(); ++i) {
    const double along = static_cast<double>(i) * step;
    while (left + 2 < n && std::abs(positions[left + 1] - positions[0]) <= along) ++left;
    const double cell = std::abs(positions[left + 1] - positions[left]);
    const double inside = along - std::abs(positions[left] - positions[0]);
    cell_.push_back(static_cast<Eigen::Index>(left));
    weight_.push_back(std::clamp(inside / cell, 0.0, 1.0));
    if (cell > kGapSteps * step && std::min(inside, cell - inside) > 0.5 * step)
      inside_gaps[i] = 1.0;
  }
  return inside_gaps;
}

std::vector<double> LowBand::shares(const std::vector<double>& samples, Boundary boundary) const {
  Workspace workspace;
  const std::span<const double> sums = transform(samples, boundary, workspace);
  std::vector<double> out(sums.begin(), sums.end());
  for (double& share : out) share *= std::pow(0.5, 0.5 * options_.level);
  return out;
}

void LowBand::find_in_gaps(const std::vector<double>& inside_gaps,
                           std::vector<char>& is_unmeasured) const {
  if (std::ranges::find(inside_gaps, 1.0) == inside_gaps.end()) return;
  const std::vector<double> share = shares(inside_gaps, options_.boundary);
  for (std::size_t j = 0; j < share.size(); ++j)
    is_unmeasured[j] |= static_cast<char>(share[j] > kMostInGaps);
}

// What a signal of ones gives that is zero beyond its ends. A short one has the ends of a long one:
// only the remainder of its length by 2^level matters.
void LowBand::find_beyond_ends(std::vector<char>& is_unmeasured) const {
  if (options_.boundary == Boundary::periodization) return;  // orthonormal
  const auto block = std::size_t{1} << options_.level, n = static_cast<std::size_t>(samples_);
  const auto taps = static_cast<std::size_t>(wavelet_.taps());
  const std::size_t both_ends = n / block > 4 * taps ? 4 * taps * block + n % block : n;
  const std::vector<double> share = shares(std::vector<double>(both_ends, 1.0), Boundary::zero);
  const std::size_t ends = share.size() / 2;
  for (std::size_t j = 0; j < share.size(); ++j)
    if (share[j] < 1.0 - kMostBeyond)
      is_unmeasured[j < ends ? j : is_unmeasured.size() - share.size() + j] = 1;
}

LowBand::Samples LowBand::samples_of(Eigen::Index first_point, Eigen::Index points) const {
  if (!resampled()) return {first_point, points};
  const Eigen::Index* const cell = cell_.data() + first_point;
  return {cell[0], cell[points - 1] + 2 - cell[0]};
}

void LowBand::bring_to_grid(std::span<const double> samples, Eigen::Index first_point,
                            std::span<double> grid) const {
  const Eigen::Index* const cell = cell_.data() + first_point;
  const double* const weight = weight_.data() + first_point;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double* const left = samples.data() + (cell[i] - cell[0]);
    grid[i] = (1.0 - weight[i]) * left[0] + weight[i] * left[1];
  }
}

void LowBand::apply(std::span<const double> signal, std::span<double> coefficients,
                    Workspace& workspace) const {
  if (resampled()) {
    workspace.grid.resize(cell_.size());
    bring_to_grid(signal, 0, workspace.grid);
    signal = workspace.grid;
  }
  std::ranges::copy(transform(signal, options_.boundary, workspace), coefficients.begin());
}

std::span<const double> LowBand::transform(std::span<const double> grid, Boundary boundary,
                                           Workspace& workspace) const {
  workspace.levels.resize(static_cast<std::size_t>(options_.level));
  for (Band& low : workspace.levels) {
    dwt(wavelet_, boundary, grid, low, nullptr);
    grid = low;
  }
  return grid;
}

void LowBand::apply(std::span<const double> signal, std::span<double> coefficients) const {
  Workspace workspace;
  apply(signal, coefficients, workspace);
}

Eigen::MatrixXd LowBand::apply(const Eigen::MatrixXd& columns) const {
  Eigen::MatrixXd out(values_, columns.cols());
  Workspace workspace;
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    apply({columns.col(j).data(), static_cast<std::size_t>(columns.rows())},
          {out.col(j).data(), static_cast<std::size_t>(values_)}, workspace);
  return out;
}

std::vector<double> LowBand::positions(std::span<const double> sample_positions) const {
  std::vector<double> mean(static_cast<std::size_t>(values_));
  apply(sample_positions, mean);
  const double scale = std::pow(0.5, 0.5 * options_.level);
  // Boundaries that do not keep constants pull the outermost values out of the trace.
  const auto [least, largest] = std::minmax(sample_positions.front(), sample_positions.back());
  for (double& position : mean) position = std::clamp(scale * position, least, largest);
  return mean;
}

std::vector<double> LowBand::reconstruct(std::span<const double> coefficients) const {
  std::vector<std::size_t> lengths;
  for (auto n = static_cast<std::size_t>(samples_); std::ssize(lengths) < options_.level;
       n = dwt_length(n, wavelet_.taps(), options_.boundary))
    lengths.push_back(n);
  std::vector<double> band(coefficients.begin(), coefficients.end());
  std::vector<double> finer;
  std::ranges::reverse(lengths);
  for (const std::size_t n : lengths) {
    finer.resize(n);
    inverse_dwt(wavelet_, options_.boundary, band, {}, finer);
    band.swap(finer);
  }
  return band;
}

}  // namespace slideway
