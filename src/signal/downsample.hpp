#pragma once

#include <cstddef>

#include "known_taps.hpp"
#include "slideway/signal/dwt.hpp"

namespace slideway {

// The window of output o is x[start + 2 o] ... x[start + 2 o + taps - 1].
inline std::ptrdiff_t window_start(Boundary boundary, std::ptrdiff_t taps) {
  return (boundary == Boundary::periodization ? taps / 2 : 1) - taps + 1;
}

// The filters of one level, high only if there is one, and where their outputs go.
struct FilterPair {
  const double *low, *high;
  double *low_out, *high_out;
};

// out[o] = Σ_j filter[j] x[2 o + taps - 1 - j]. Taps = 0: their number is known at run time only.
template <std::ptrdiff_t Taps, bool High>
void convolve(const FilterPair& pair, std::ptrdiff_t taps, const double* x, std::ptrdiff_t count) {
  if constexpr (Taps > 0) taps = Taps;
  const double *low = pair.low, *high = pair.high;
  double *low_out = pair.low_out, *high_out = pair.high_out;
  for (std::ptrdiff_t o = 0; o < count; ++o, x += 2) {
    double low_sum = 0.0, high_sum = 0.0;
    for (std::ptrdiff_t j = 0; j < taps; ++j) {
      low_sum += low[j] * x[taps - 1 - j];
      if constexpr (High) high_sum += high[j] * x[taps - 1 - j];
    }
    low_out[o] = low_sum;
    if constexpr (High) high_out[o] = high_sum;
  }
}

inline void convolve(const FilterPair& pair, std::ptrdiff_t taps, const double* x,
                     std::ptrdiff_t count) {
  with_known_taps(taps, [&](auto known) {
    if (pair.high != nullptr)
      convolve<known(), true>(pair, taps, x, count);
    else
      convolve<known(), false>(pair, taps, x, count);
  });
}

}  // namespace slideway
