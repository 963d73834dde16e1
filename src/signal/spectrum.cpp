#include "slideway/signal/spectrum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "fourier.hpp"

namespace slideway {

std::vector<double> power_spectrum(std::span<const double> values) {
  const std::vector<std::complex<double>> transform = fourier(values);
  if (transform.empty()) return {};
  std::vector<double> power(values.size() / 2 + 1);
  std::transform(transform.begin(), transform.begin() + std::ssize(power), power.begin(),
                 [](const std::complex<double>& value) { return std::norm(value); });
  return power;
}

Spectrum amplitude_spectrum(std::span<const double> series, int per_decade) {
  Spectrum out;
  if (series.size() < 4) return out;
  const auto n = static_cast<double>(series.size());
  const double mean = std::accumulate(series.begin(), series.end(), 0.0) / n;
  std::vector<double> padded(std::bit_ceil(series.size()), 0.0);
  std::transform(series.begin(), series.end(), padded.begin(), [&](double v) { return v - mean; });
  const std::vector<std::complex<double>> transform = fourier(padded);
  int last = 0;
  for (std::size_t k = 1; k <= padded.size() / 2; ++k) {
    const double frequency = static_cast<double>(k) / static_cast<double>(padded.size());
    if (frequency * n < 1.0) continue;  // less than one period in the series
    const double amplitude = std::abs(transform[k]) * 2.0 / n;
    const int place = static_cast<int>(std::floor(std::log10(frequency) * per_decade));
    if (out.amplitude.empty() || place != last) {
      out.cycles_per_sample.push_back(frequency);
      out.amplitude.push_back(amplitude);
    } else if (amplitude > out.amplitude.back()) {
      out.cycles_per_sample.back() = frequency;
      out.amplitude.back() = amplitude;
    }
    last = place;
  }
  return out;
}

}  // namespace slideway
