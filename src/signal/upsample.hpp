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

// Half = 0: half the taps are known at run time only.
template <std::ptrdiff_t Half, typename Put>
void put_pairs(std::span<const double> filter, const double* c, std::ptrdiff_t count, Put put) {
  const std::ptrdiff_t half = Half > 0 ? Half : std::ssize(filter) / 2;
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
  switch (filter.size()) {
    case 2:
      return put_pairs<1>(filter, c, count, put);
    case 4:
      return put_pairs<2>(filter, c, count, put);
    case 6:
      return put_pairs<3>(filter, c, count, put);
    case 8:
      return put_pairs<4>(filter, c, count, put);
    default:
      return put_pairs<0>(filter, c, count, put);
  }
}

}  // namespace slideway
