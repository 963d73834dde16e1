#include "slideway/signal/spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "signal/noise.hpp"
#include "slideway/base/units.hpp"

namespace slideway::spectrum_test {
namespace {

constexpr double kEpsilon = 2.2e-16;

// Fast lengths of kissfft, odd ones, primes, and twice a prime.
class PowerSpectrumOfLength : public testing::TestWithParam<int> {};

// Σ |X_k|² = n Σ x_t²; k and n - k have the same power.
TEST_P(PowerSpectrumOfLength, ObeysParsevalsTheorem) {
  const int n = GetParam();
  const std::vector<double> x = white_noise(n, "parseval");
  const std::vector<double> power = power_spectrum(x);
  ASSERT_EQ(power.size(), static_cast<std::size_t>(n / 2 + 1));
  double sum = power[0];
  for (int k = 1; k <= n / 2; ++k) sum += (2 * k == n ? 1.0 : 2.0) * power[k];
  const double squares = std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
  // Each value is rounded log2(n) times or so; ten times that of the sum.
  EXPECT_NEAR(sum / (n * squares), 1.0, 10.0 * kEpsilon * (1.0 + std::log2(n)));
}

// A cosine of amplitude A with k periods in n samples: (A n / 2)² at k and nothing elsewhere.
TEST_P(PowerSpectrumOfLength, HasALineWhereTheCosineIs) {
  constexpr double kAmplitude = 0.7;
  const int n = GetParam(), line = n / 3;
  std::vector<double> x(n);
  for (int t = 0; t < n; ++t) x[t] = kAmplitude * std::cos(2.0 * kPi * (line * t % n) / n + 0.3);
  const std::vector<double> power = power_spectrum(x);
  const double expected = std::pow(0.5 * kAmplitude * n, 2);
  for (int k = 0; k <= n / 2; ++k)
    EXPECT_NEAR(power[k] / expected, k == line ? 1.0 : 0.0, 1e-13 * n) << k << " of " << n;
}

INSTANTIATE_TEST_SUITE_P(Lengths, PowerSpectrumOfLength,
                         testing::Values(3, 4, 7, 61, 64, 94, 625, 1013));

// The definition, term by term.
TEST(PowerSpectrum, IsTheSquareOfTheFourierSum) {
  for (const int n : {1, 2, 5, 12, 13, 97, 110}) {
    const std::vector<double> x = white_noise(n, "direct");
    const std::vector<double> power = power_spectrum(x);
    for (int k = 0; k <= n / 2; ++k) {
      double c = 0.0, s = 0.0;
      for (int t = 0; t < n; ++t) {
        c += x[t] * std::cos(2.0 * kPi * (k * t % n) / n);
        s += x[t] * std::sin(2.0 * kPi * (k * t % n) / n);
      }
      EXPECT_NEAR(power[k], c * c + s * s, 1e-12 * n * n) << k << " of " << n;
    }
  }
}

TEST(PowerSpectrum, OfNothingIsEmpty) {
  EXPECT_TRUE(power_spectrum(std::vector<double>{}).empty());
}

TEST(AmplitudeSpectrum, FindsASineOfItsAmplitudeAtItsFrequency) {
  constexpr double kFrequency = 64.0 / 1024.0, kAmplitude = 0.7;
  std::vector<double> series(1024);
  for (std::size_t i = 0; i < series.size(); ++i)
    series[i] = 5.0 + kAmplitude * std::sin(2.0 * kPi * kFrequency * static_cast<double>(i));
  const Spectrum found = amplitude_spectrum(series, 100);
  const auto most = std::max_element(found.amplitude.begin(), found.amplitude.end());
  EXPECT_NEAR(*most, kAmplitude, 1e-9);  // a whole number of periods: no leakage
  EXPECT_NEAR(found.cycles_per_sample[most - found.amplitude.begin()], kFrequency, 1e-12);
}

TEST(AmplitudeSpectrum, OfNothingIsEmpty) {
  EXPECT_TRUE(amplitude_spectrum(std::vector<double>{1, 2}, 10).amplitude.empty());
}

}  // namespace
}  // namespace slideway::spectrum_test
