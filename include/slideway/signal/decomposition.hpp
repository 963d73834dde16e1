#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "slideway/signal/dwt.hpp"

namespace slideway {

/// Wavelet decomposition: the approximation of the last level and the details of every level.
struct Decomposition {
  Band approximation;                // a_L
  std::vector<Band> details;         // details[j-1] is d_j
  std::vector<std::size_t> lengths;  // lengths[j] samples before level j+1; lengths[0] = N
};

/// The discrete wavelet transform over `levels` levels. Long signals are transformed in parts, on
/// all threads.
/// @throws UsageError for a negative level, DataError for one or more of a signal without samples.
Decomposition decompose(const Wavelet& wavelet, Boundary boundary, int levels,
                        std::span<const double> signal);

}  // namespace slideway
