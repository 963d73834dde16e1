#pragma once

#include <cstddef>
#include <span>

#include "known_taps.hpp"
#include "slideway/signal/dwt.hpp"

namespace slideway {

// The dyadic upsampling of c, filtered: with u = m + shift, i = floor(u / 2), p = u mod 2,
// signal[m] = Σ_j filter[2 j + p] c[i - j].
inline std::ptrdiff_t upsampling_shift(Boundary boundary, std::ptrdiff_t half) {
  return boundary == Boundary::periodization ? half - 1 : 2 * half - 2;
}

// What becomes of the filtered signal's sample m.
struct Set {
  double* out;
  void operator()(std::ptrdiff_t m, double value) const { out[m] = value; }
};
struct Add {
  double* out;
  void operator()(std::ptrdiff_t m, double value) const { out[m] += value; }
};
struct SetAndSum {
  double* out;
  const double* other;
  double* sum;
  void operator()(std::ptrdiff_t m, double value) const {
    out[m] = value;
    sum[m] = other[m] + value;
  }
};

// Taps = 0: their number is known at run time only.
template <std::ptrdiff_t Taps, typename Put>
void put_pairs(std::span<const double> filter, const double* c, std::ptrdiff_t count, Put put) {
  const std::ptrdiff_t half = (Taps > 0 ? Taps : std::ssize(filter)) / 2;
  const double* f = filter.data();
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    double even = f[0] * c[i], odd = f[1] * c[i];
    for (std::ptrdiff_t j = 1; j < half; ++j) {
      even += f[2 * j] * c[i - j];
      odd += f[2 * j + 1] * c[i - j];
    }
    put(2 * i, even);
    put(2 * i + 1, odd);
  }
}

// put(2 i + p, Σ_j filter[2 j + p] c[i - j]) for 0 <= i < count and p of 0 and 1.
template <typename Put>
void put_pairs(std::span<const double> filter, const double* c, std::ptrdiff_t count, Put put) {
  with_known_taps(std::ssize(filter),
                  [&](auto known) { put_pairs<known()>(filter, c, count, put); });
}

}  // namespace slideway
