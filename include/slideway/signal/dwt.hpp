#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "slideway/signal/daubechies.hpp"

namespace slideway {

/// How a signal goes on beyond its ends; the names of PyWavelets.
enum class Boundary {
  zero,
  constant,
  symmetric,
  periodic,
  smooth,
  periodization,
  reflect,
  antisymmetric,
  antireflect
};

inline constexpr std::string_view kBoundaries =
    "zero constant symmetric periodic smooth periodization reflect antisymmetric antireflect";

/// @throws UsageError listing what is accepted.
Boundary boundary(std::string_view name);
std::string_view name(Boundary boundary);

/// Number of coefficients one level makes of n samples: (n + taps - 1) / 2, rounded down;
/// ceil(n / 2) under periodization.
std::size_t dwt_length(std::size_t n, int taps, Boundary boundary);

/// One level of the discrete wavelet transform. `low` and `high` are resized; `high` may be null.
/// Any length n >= 1.
void dwt(const Wavelet& wavelet, Boundary boundary, std::span<const double> signal,
         std::vector<double>& low, std::vector<double>* high);

/// One level of the inverse transform of low and high (either may be empty: then zeros), cut to
/// the size of the signal (as it was before that level).
void inverse_dwt(const Wavelet& wavelet, Boundary boundary, std::span<const double> low,
                 std::span<const double> high, std::span<double> signal);

/// All levels of a signal: approximation of the last level and the details of each.
struct Decomposition {
  std::vector<double> approximation;         // a_L
  std::vector<std::vector<double>> details;  // details[j-1] is d_j
  std::vector<std::size_t> lengths;          // lengths[j] samples before level j+1; lengths[0] = N
};

Decomposition decompose(const Wavelet& wavelet, Boundary boundary, int levels,
                        std::span<const double> signal);

}  // namespace slideway
