#include "slideway/base/statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "slideway/base/parallel.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

constexpr std::size_t kPart = 1 << 15;  // values that stay in the cache
constexpr std::size_t kLanes = 4;       // independent sums

struct Part {
  double count = 0.0, mean = 0.0, squares = 0.0;  // about the mean
  double least = 0.0, largest = 0.0;
};

template <typename Term>
double sum_of(std::span<const double> values, Term&& term) {
  std::array<double, kLanes> sums{};
  std::size_t i = 0;
  for (; i + kLanes <= values.size(); i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k) sums[k] += term(values[i + k]);
  for (; i < values.size(); ++i) sums[0] += term(values[i]);
  return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

Part part_of(std::span<const double> values) {
  Part out{static_cast<double>(values.size())};
  const double first = values[0];  // differences from it avoid cancellation
  out.mean = first + sum_of(values, [&](double v) { return v - first; }) / out.count;
  out.squares = sum_of(values, [&](double v) { return (v - out.mean) * (v - out.mean); });
  std::array<double, 2 * kLanes> least, largest;
  least.fill(first);
  largest.fill(first);
  std::size_t i = 0;
  for (; i + least.size() <= values.size(); i += least.size())
    for (std::size_t k = 0; k < least.size(); ++k) {
      least[k] = std::min(least[k], values[i + k]);
      largest[k] = std::max(largest[k], values[i + k]);
    }
  for (; i < values.size(); ++i) {
    least[0] = std::min(least[0], values[i]);
    largest[0] = std::max(largest[0], values[i]);
  }
  out.least = std::ranges::min(least);
  out.largest = std::ranges::max(largest);
  return out;
}

Part combined(const Part& a, const Part& b) {
  const double count = a.count + b.count, step = b.mean - a.mean, share = b.count / count;
  return {count, a.mean + share * step, a.squares + b.squares + a.count * share * step * step,
          std::min(a.least, b.least), std::max(a.largest, b.largest)};
}

}  // namespace

Statistics statistics_of(std::span<const double> values) {
  std::vector<Part> parts(parts_of(values.size(), kPart));
  parallel_parts(values.size(), kPart, [&](std::size_t p, std::size_t first, std::size_t last) {
    wide([&] { parts[p] = part_of(values.subspan(first, last - first)); });
  });
  Part all = parts[0];
  for (std::size_t p = 1; p < parts.size(); ++p) all = combined(all, parts[p]);
  return {all.mean, std::sqrt(all.squares / all.count), all.least, all.largest};
}

double median(std::span<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

double deviation_of_most(std::span<const double> values) {
  constexpr double kNormal = 0.6744897501960817;  // median of the size of a standard normal value
  std::vector<double> sizes;
  for (const double value : values) sizes.push_back(std::abs(value));
  return median(sizes) / kNormal;
}

}  // namespace slideway
