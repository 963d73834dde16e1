#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace slideway {

// Appends a part of a series, of which `share` is there with it: memory is asked for once.
inline void append(std::span<const double> part, double share, std::vector<double>& series) {
  if (series.empty() && share < 1.0)  // 2 % for shorter lines to come
    series.reserve(static_cast<std::size_t>(1.02 * static_cast<double>(part.size()) / share));
  series.insert(series.end(), part.begin(), part.end());
}

}  // namespace slideway
