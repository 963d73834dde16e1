#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "slideway/base/random.hpp"

/// Signals the tests of this room share; seeded, so that every run sees the same.
namespace slideway {

inline std::vector<double> white_noise(std::size_t n, std::string_view stream) {
  RandomStream random(20, stream);
  std::vector<double> signal(n);
  for (double& value : signal) value = random.normal();
  return signal;
}

inline double largest(std::span<const double> values) {
  double size = 0.0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

}  // namespace slideway
