#include "fourier.hpp"

#include <unsupported/Eigen/FFT>

#include "slideway/base/units.hpp"

namespace slideway {
namespace {

using Values = std::vector<std::complex<double>>;

// Bluestein's algorithm (1970): with k t = (k² + t² - (k - t)²) / 2 the transform is a convolution
// with w_j = e^(πi j² / n), done in a fast length.
Values bluestein(std::span<const double> x) {
  const std::size_t n = x.size(), size = fast_length(2 * n - 1);
  Values w(n), signal(size), kernel(size), out;
  for (std::size_t j = 0; j < n; ++j)  // j² modulo the period 2 n keeps the angle exact
    w[j] = std::polar(1.0, kPi * static_cast<double>(j * j % (2 * n)) / static_cast<double>(n));
  for (std::size_t t = 0; t < n; ++t) {
    signal[t] = x[t] * std::conj(w[t]);
    kernel[t] = kernel[(size - t) % size] = w[t];
  }
  Eigen::FFT<double> fft;
  Values signal_spectrum, kernel_spectrum;
  fft.fwd(signal_spectrum, signal);
  fft.fwd(kernel_spectrum, kernel);
  for (std::size_t f = 0; f < size; ++f) signal_spectrum[f] *= kernel_spectrum[f];
  fft.inv(out, signal_spectrum);
  out.resize(n);
  for (std::size_t k = 0; k < n; ++k) out[k] *= std::conj(w[k]);
  return out;
}

}  // namespace

std::size_t fast_length(std::size_t least) {
  for (std::size_t size = least;; ++size) {
    std::size_t rest = size;
    for (const std::size_t factor : {2, 3, 5})
      while (rest % factor == 0) rest /= factor;
    if (rest == 1) return size;
  }
}

std::vector<std::complex<double>> fourier(std::span<const double> values) {
  if (values.size() < 2) return {values.begin(), values.end()};  // kissfft does not take them
  if (fast_length(values.size()) != values.size()) return bluestein(values);
  Values out;
  Eigen::FFT<double>().fwd(out, std::vector<double>(values.begin(), values.end()));
  return out;
}

}  // namespace slideway
