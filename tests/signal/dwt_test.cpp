#include "slideway/signal/bands.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "signal/noise.hpp"
#include "slideway/base/error.hpp"
#include "slideway/signal/decomposition.hpp"

namespace slideway::dwt_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

std::vector<Boundary> all_boundaries() {
  std::vector<Boundary> all;
  for (int i = 0; i <= static_cast<int>(Boundary::antireflect); ++i)
    all.push_back(static_cast<Boundary>(i));
  return all;
}

double energy(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.0);
}

TEST(Boundary, NamesAreThoseOfPyWavelets) {
  std::string names;
  for (const Boundary each : all_boundaries()) {
    EXPECT_EQ(boundary(name(each)), each);
    names += std::string(names.empty() ? "" : " ") + std::string(name(each));
  }
  EXPECT_EQ(names,
            "zero constant symmetric periodic smooth periodization reflect antisymmetric "
            "antireflect");
  EXPECT_EQ(boundary("reflect"), Boundary::reflect);
}

TEST(Boundary, RefusesOtherNamesAndSaysWhatIsAccepted) {
  for (const char* other : {"", "sym", "zero constant", "Zero", " "}) {
    try {
      boundary(other);
      ADD_FAILURE() << "accepted '" << other << "'";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr("accepted: zero constant symmetric"));
    }
  }
}

TEST(Dwt, OfDb1IsScaledSumsAndDifferencesOfPairs) {
  const std::vector<double> signal{3.0, 1.0, -2.0, 4.0};
  Band low, high;
  for (const Boundary each : all_boundaries()) {
    dwt(daubechies("db1"), each, signal, low, &high);
    const double root = std::sqrt(2.0);
    EXPECT_THAT(low, ElementsAre(DoubleNear(4.0 / root, 1e-15), DoubleNear(2.0 / root, 1e-15)));
    EXPECT_THAT(high, ElementsAre(DoubleNear(2.0 / root, 1e-15), DoubleNear(-6.0 / root, 1e-15)));
  }
}

TEST(Dwt, RefusesASignalWithoutSamples) {
  Band low;
  EXPECT_THROW(dwt(daubechies("db2"), Boundary::symmetric, {}, low, nullptr), DataError);
}

TEST(Dwt, IsUndoneByItsInverseForEveryWaveletBoundaryAndLength) {
  Band low, high, restored;
  for (int number = 1; number <= 19; ++number) {
    const Wavelet wavelet = daubechies("db" + std::to_string(number));
    for (const Boundary each : all_boundaries())
      for (std::size_t n = 1; n <= 90; ++n) {
        const std::vector<double> signal = white_noise(n, "inverse");
        dwt(wavelet, each, signal, low, &high);
        EXPECT_EQ(low.size(), dwt_length(n, wavelet.taps(), each));
        EXPECT_EQ(high.size(), low.size());
        restored.resize(n);
        inverse_dwt(wavelet, each, low, high, restored);
        // Each end value is up to 38 products of coefficients that extrapolate as far as 38 steps.
        const double size = std::max(largest(low), largest(high));
        EXPECT_THAT(restored, Pointwise(DoubleNear(1e-13 * size), signal))
            << wavelet.name << ' ' << name(each) << ' ' << n;
      }
  }
}

// The transform is orthonormal on a circle.
TEST(Dwt, KeepsTheEnergyOfEvenLengthsUnderPeriodization) {
  Band low, high;
  for (int number = 1; number <= 19; ++number)
    for (const std::size_t n : {2u, 6u, 38u, 40u, 1000u}) {
      const std::vector<double> signal = white_noise(n, "energy");
      dwt(daubechies("db" + std::to_string(number)), Boundary::periodization, signal, low, &high);
      // Rounding of n squares.
      EXPECT_NEAR((energy(low) + energy(high)) / energy(signal), 1.0, 1e-14) << number << ' ' << n;
    }
}

TEST(Dwt, DetailsOfPolynomialsBelowTheNumberVanishAwayFromTheEnds) {
  constexpr std::size_t kSamples = 200;
  Band low, high;
  for (int number = 1; number <= 19; ++number) {
    const Wavelet wavelet = daubechies("db" + std::to_string(number));
    std::vector<double> signal(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i)  // of the largest degree, at most 1
      signal[i] = std::pow(2.0 * static_cast<double>(i) / (kSamples - 1) - 1.0, number - 1);
    dwt(wavelet, Boundary::symmetric, signal, low, &high);
    const std::size_t end = static_cast<std::size_t>(number);
    for (std::size_t k = end; k + end < high.size(); ++k)
      EXPECT_NEAR(high[k], 0.0, 1e-14) << wavelet.name << ' ' << k;
  }
}

TEST(Dwt, OnePointBoundariesOfASingleSampleGoOnAsAConstant) {
  const Wavelet wavelet = daubechies("db3");
  Band expected, low;
  dwt(wavelet, Boundary::constant, std::vector{2.5}, expected, nullptr);
  for (const Boundary each : {Boundary::smooth, Boundary::reflect, Boundary::antireflect}) {
    dwt(wavelet, each, std::vector{2.5}, low, nullptr);
    EXPECT_EQ(low, expected);
  }
}

TEST(Decomposition, OfALongSignalIsThatOfOneLevelAfterAnother) {
  for (const int number : {1, 2, 3, 4, 12})
    for (const Boundary each : all_boundaries())
      for (const std::size_t n : {70'001u, 200'035u})
        for (const int levels : {1, 5, 8}) {
          const Wavelet wavelet = daubechies("db" + std::to_string(number));
          const std::vector<double> signal = white_noise(n, "decomposition");
          const Decomposition found = decompose(wavelet, each, levels, signal);
          Band low(signal.begin(), signal.end()), coarser, detail;
          for (int j = 0; j < levels; ++j) {
            EXPECT_EQ(found.lengths[j], low.size());
            dwt(wavelet, each, low, coarser, &detail);
            EXPECT_TRUE(found.details[j] == detail)
                << wavelet.name << ' ' << name(each) << ' ' << n << " level " << j + 1;
            low.swap(coarser);
          }
          EXPECT_TRUE(found.approximation == low) << wavelet.name << ' ' << name(each) << ' ' << n;
        }
}

TEST(Bands, AddUpToTheSignalAndTelescope) {
  for (const int number : {1, 2, 4, 7, 12, 19})
    for (const Boundary each : all_boundaries())
      for (const std::size_t n : {1u, 2u, 33u, 64u, 129u, 1001u}) {
        const Wavelet wavelet = daubechies("db" + std::to_string(number));
        const std::vector<double> signal = white_noise(n, "bands");
        const Bands bands = reconstruct_bands(wavelet, each, 5, signal);
        ASSERT_EQ(bands.approximations.size(), 5u);
        ASSERT_EQ(bands.details.size(), 5u);
        std::vector<double> rest = signal;
        for (std::size_t j = 0; j < 5; ++j) {
          ASSERT_EQ(bands.details[j].size(), n);
          for (std::size_t i = 0; i < n; ++i) rest[i] -= bands.details[j][i];
          EXPECT_THAT(bands.approximations[j], Pointwise(DoubleNear(1e-13 * largest(signal)), rest))
              << wavelet.name << ' ' << name(each) << ' ' << n << " level " << j + 1;
        }
      }
}

// Coefficients of level `level` of a signal of n samples, the rest being zeros.
Band at_full_length(const Wavelet& wavelet, Boundary boundary, const Decomposition& parts,
                    std::size_t level, bool is_detail) {
  Band low = is_detail ? Band() : parts.approximation;
  Band high = is_detail ? parts.details[level - 1] : Band();
  for (std::size_t j = level; j > 0; --j) {
    Band finer(parts.lengths[j - 1]);
    inverse_dwt(wavelet, boundary, low, high, finer);
    low = std::move(finer);
    high.clear();
  }
  return low;
}

TEST(Bands, OfALongSignalAreTheInverseTransformsOfTheirCoefficients) {
  for (const int number : {1, 2, 3, 4, 12})
    for (const Boundary each : all_boundaries())
      for (const std::size_t n : {40'000u, 70'001u, 70'035u}) {
        const Wavelet wavelet = daubechies("db" + std::to_string(number));
        const std::vector<double> signal = white_noise(n, "long");
        const Decomposition parts = decompose(wavelet, each, 5, signal);
        const Bands bands = reconstruct_bands(wavelet, each, 5, signal);
        const auto expect_same = [&](const Band& found, std::size_t level, bool is_detail) {
          const auto expected = at_full_length(wavelet, each, parts, level, is_detail);
          EXPECT_TRUE(std::ranges::equal(found, expected))
              << wavelet.name << ' ' << name(each) << ' ' << n << " level " << level;
        };
        expect_same(bands.approximations[4], 5, false);
        for (std::size_t j = 1; j <= 5; ++j) expect_same(bands.details[j - 1], j, true);
      }
}

TEST(Bands, ApproximationOfDb1IsTheMeanOfEachBlock) {
  const std::vector<double> signal = white_noise(64, "blocks");
  const Bands bands = reconstruct_bands(daubechies("db1"), Boundary::symmetric, 3, signal);
  for (std::size_t i = 0; i < signal.size(); ++i) {
    const auto block = signal.begin() + static_cast<std::ptrdiff_t>(i / 8 * 8);
    EXPECT_NEAR(bands.approximations[2][i], std::accumulate(block, block + 8, 0.0) / 8.0, 1e-15);
  }
}

TEST(Bands, OfNoLevelAreNone) {
  const std::vector<double> signal{1.0, 2.0, 4.0};
  EXPECT_TRUE(reconstruct_bands(daubechies("db2"), Boundary::zero, 0, signal).details.empty());
  EXPECT_EQ(decompose(daubechies("db2"), Boundary::zero, 0, signal).approximation,
            Band(signal.begin(), signal.end()));
  EXPECT_THROW(decompose(daubechies("db2"), Boundary::zero, -1, signal), UsageError);
}

}  // namespace
}  // namespace slideway::dwt_test
