#include "slideway/signal/thin.hpp"

#include <algorithm>
#include <numeric>

namespace slideway {
namespace {

/// Calls visit(first, last) for each of so many equal stretches of n samples.
template <typename Visit>
void for_each_stretch(std::size_t n, std::size_t stretches, Visit&& visit) {
  for (std::size_t i = 0; i < stretches; ++i) visit(i * n / stretches, (i + 1) * n / stretches);
}

std::ptrdiff_t at(std::size_t index) { return static_cast<std::ptrdiff_t>(index); }

}  // namespace

std::vector<std::size_t> thinned(const std::vector<std::span<const double>>& series,
                                 std::size_t limit) {
  const std::size_t n = series.front().size();
  if (n <= limit) {
    std::vector<std::size_t> all(n);
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }
  std::vector<std::size_t> out{0, n - 1};
  for (const std::span<const double> each : series)
    for_each_stretch(n, (limit - 2) / (2 * series.size()),
                     [&](std::size_t first, std::size_t last) {
                       const auto [low, high] =
                           std::minmax_element(each.begin() + at(first), each.begin() + at(last));
                       out.push_back(static_cast<std::size_t>(low - each.begin()));
                       out.push_back(static_cast<std::size_t>(high - each.begin()));
                     });
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Envelope envelope(std::span<const double> series, std::size_t stretches) {
  Envelope out;
  for_each_stretch(series.size(), std::min(stretches, series.size()),
                   [&](std::size_t first, std::size_t last) {
                     const auto [low, high] =
                         std::minmax_element(series.begin() + at(first), series.begin() + at(last));
                     out.low.push_back(*low);
                     out.high.push_back(*high);
                   });
  return out;
}

}  // namespace slideway
