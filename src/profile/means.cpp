#include "slideway/profile/means.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slideway/signal/low_band.hpp"

namespace slideway {
namespace {

double mean_of(const std::vector<double>& values, std::size_t first, std::size_t last) {
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  const auto end = values.begin() + static_cast<std::ptrdiff_t>(last);
  return std::accumulate(begin, end, 0.0) / static_cast<double>(last - first);
}

}  // namespace

Profile means_of(const Profile& profile, std::size_t count) {
  Profile out = profile;
  out.positions.clear();
  out.values.clear();
  const std::vector<double>& at = profile.positions;
  if (at.empty()) return out;
  const double gap = kGapSteps * std::abs(at.back() - at.front()) /
                     static_cast<double>(std::max<std::size_t>(at.size() - 1, 1));
  for (std::size_t first = 0; first < at.size();) {
    std::size_t last = first + 1;
    while (last < at.size() && last - first < count && std::abs(at[last] - at[last - 1]) <= gap)
      ++last;
    out.positions.push_back(mean_of(at, first, last));
    out.values.push_back(mean_of(profile.values, first, last));
    first = last;
  }
  if (out.standard_uncertainty) *out.standard_uncertainty /= std::sqrt(static_cast<double>(count));
  return out;
}

}  // namespace slideway
