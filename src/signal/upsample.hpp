#pragma once

#include <cstddef>
#include <span>

#include "slideway/signal/dwt.hpp"

namespace slideway {

// The dyadic upsampling of c, filtered: with u = m + shift, i = floor(u / 2), p = u mod 2,
// signal[m] = Σ_j filter[2 j + p] c[i - j].
inline std::ptrdiff_t upsampling_shift(Boundary boundary, std::ptrdiff_t half) {
  return boundary == Boundary::periodization ? half - 1 : 2 * half - 2;
}

// Half = 0: half the taps are known at run time only.
template <bool Adds, std::ptrdiff_t Half>
void pairs_of(std::span<const double> filter, const double* c, std::ptrdiff_t count, double* out) {
  const std::ptrdiff_t half = Half > 0 ? Half : std::ssize(filter) / 2;
  const double* f = filter.data();
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double even = 0.0, odd = 0.0;
    for (std::ptrdiff_t j = 0; j < half; ++j) {
      even += f[2 * j] * c[i - j];
      odd += f[2 * j + 1] * c[i - j];
    }
    out[2 * i] = (Adds ? out[2 * i] : 0.0) + even;
    out[2 * i + 1] = (Adds ? out[2 * i + 1] : 0.0) + odd;
  }
}

// out[2 i + p] = Σ_j filter[2 j + p] c[i - j], or adds that, for 0 <= i < count and p of 0 and 1.
template <bool Adds>
void fill_pairs(std::span<const double> filter, const double* c, std::ptrdiff_t count,
                double* out) {
  switch (filter.size()) {
    case 2:
      return pairs_of<Adds, 1>(filter, c, count, out);
    case 4:
      return pairs_of<Adds, 2>(filter, c, count, out);
    case 6:
      return pairs_of<Adds, 3>(filter, c, count, out);
    case 8:
      return pairs_of<Adds, 4>(filter, c, count, out);
    default:
      return pairs_of<Adds, 0>(filter, c, count, out);
  }
}

}  // namespace slideway
