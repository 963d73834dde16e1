#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "slideway/signal/daubechies.hpp"

namespace slideway {

/// An allocator whose resize does not zero the memory, which would take as long as the transform.
template <typename Value>
struct Unset : std::allocator<Value> {
  template <typename Other, typename... Arguments>
  void construct(Other* at, Arguments&&... arguments) {
    if constexpr (sizeof...(Arguments) > 0)
      std::construct_at(at, std::forward<Arguments>(arguments)...);
  }
};
/// Samples or coefficients of a band.
using Band = std::vector<double, Unset<double>>;

/// Extension of a signal beyond its ends, with the names of PyWavelets.
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

/// Number of coefficients of one level from n samples: (n + taps - 1) / 2, rounded down;
/// ceil(n / 2) under periodization.
std::size_t dwt_length(std::size_t n, int taps, Boundary boundary);

/// One level of the discrete wavelet transform. `low` and `high` are resized; `high` may be null.
/// Any length n >= 1.
void dwt(const Wavelet& wavelet, Boundary boundary, std::span<const double> signal, Band& low,
         Band* high);

/// One level of the inverse transform of low and high (either may be empty: then zeros), cut to
/// the size of the signal (as it was before that level).
void inverse_dwt(const Wavelet& wavelet, Boundary boundary, std::span<const double> low,
                 std::span<const double> high, std::span<double> signal);

}  // namespace slideway
