#pragma once

#include <span>
#include <vector>

#include "slideway/signal/dwt.hpp"

namespace slideway {

/// The bands at full length: a_1 ... a_L and d_1 ... d_L, each of N samples; a_L + Σ_j d_j is the
/// signal to 1e-13 of its size.
struct Bands {
  std::vector<Band> approximations;  // [j-1] is a_j
  std::vector<Band> details;         // [j-1] is d_j
};

Bands reconstruct_bands(const Wavelet& wavelet, Boundary boundary, int levels,
                        std::span<const double> signal);

}  // namespace slideway
