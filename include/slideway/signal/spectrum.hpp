#pragma once

#include <span>
#include <vector>

/// Spectra of uniform series by the fast Fourier transform, in O(n log n) for every length n.
namespace slideway {

/// |X_k|², k = 0 ... n/2 (rounded down), of the discrete Fourier transform
///   X_k = Σ_t x_t e^(-2πi k t / n),
/// at k / n cycles per sample, in the square of the values' unit. The mean is not removed. Empty
/// for an empty series.
std::vector<double> power_spectrum(std::span<const double> values);

/// Amplitude at each frequency of a uniform series, its mean removed, padded with zeros to a power
/// of two. A sine of amplitude A at a frequency k / n has A there. Of each of `per_decade`
/// intervals of a decade only the largest amplitude is kept. Empty for fewer than four values.
struct Spectrum {
  std::vector<double> cycles_per_sample, amplitude;
};
Spectrum amplitude_spectrum(std::span<const double> series, int per_decade);

}  // namespace slideway
