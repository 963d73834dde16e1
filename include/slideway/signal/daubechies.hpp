#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// A Daubechies wavelet's four filters, each of 2N taps, in PyWavelets' and MATLAB's orientation.
struct Wavelet {
  std::string name;
  std::vector<double> decompose_low, decompose_high;
  std::vector<double> reconstruct_low, reconstruct_high;
  [[nodiscard]] int taps() const { return static_cast<int>(decompose_low.size()); }
};

/// "db1" ... "db19" (taps from Boost.Math; quadrature-mirror pair, Eqs. (7) and (8)).
/// @throws UsageError for any other name, listing what is accepted.
Wavelet daubechies(std::string_view name);

}  // namespace slideway
