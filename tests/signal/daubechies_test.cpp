#include "slideway/signal/daubechies.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "slideway/base/error.hpp"

namespace slideway::daubechies_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;

// The taps are sums and products of at most 38 numbers below 1: some 1e-15.
constexpr double kRounding = 2e-15;

std::vector<Wavelet> all_wavelets() {
  std::vector<Wavelet> all;
  for (int n = 1; n <= 19; ++n) all.push_back(daubechies("db" + std::to_string(n)));
  return all;
}

TEST(Daubechies, HasTwiceAsManyTapsAsItsNumber) {
  int n = 0;
  for (const Wavelet& wavelet : all_wavelets()) {
    EXPECT_EQ(wavelet.name, "db" + std::to_string(++n));
    EXPECT_EQ(wavelet.taps(), 2 * n);
    EXPECT_EQ(wavelet.decompose_high.size(), wavelet.decompose_low.size());
    EXPECT_EQ(wavelet.reconstruct_low.size(), wavelet.decompose_low.size());
    EXPECT_EQ(wavelet.reconstruct_high.size(), wavelet.decompose_low.size());
  }
}

TEST(Daubechies, FiltersAreOrthonormalToTheirEvenShifts) {
  for (const Wavelet& wavelet : all_wavelets()) {
    const std::vector<double>& low = wavelet.decompose_low;
    const std::vector<double>& high = wavelet.decompose_high;
    for (std::size_t shift = 0; shift < low.size(); shift += 2) {
      double low_low = 0.0, high_high = 0.0, low_high = 0.0, high_low = 0.0;
      for (std::size_t k = shift; k < low.size(); ++k) {
        low_low += low[k] * low[k - shift];
        high_high += high[k] * high[k - shift];
        low_high += low[k] * high[k - shift];
        high_low += high[k] * low[k - shift];
      }
      const double unit = shift == 0 ? 1.0 : 0.0;
      EXPECT_NEAR(low_low, unit, kRounding) << wavelet.name << " shift " << shift;
      EXPECT_NEAR(high_high, unit, kRounding) << wavelet.name << " shift " << shift;
      EXPECT_NEAR(low_high, 0.0, kRounding) << wavelet.name << " shift " << shift;
      EXPECT_NEAR(high_low, 0.0, kRounding) << wavelet.name << " shift " << shift;
    }
  }
}

TEST(Daubechies, HighFilterAnnihilatesPolynomialsBelowItsNumber) {
  for (const Wavelet& wavelet : all_wavelets()) {
    const double last = wavelet.taps() - 1;
    for (int power = 0; power < wavelet.taps() / 2; ++power) {
      double moment = 0.0;  // on [-1, 1], so that no power exceeds 1
      for (int k = 0; k < wavelet.taps(); ++k)
        moment += wavelet.decompose_high[k] * std::pow(2.0 * k / last - 1.0, power);
      EXPECT_NEAR(moment, 0.0, kRounding) << wavelet.name << " power " << power;
    }
  }
}

TEST(Daubechies, LowFilterSumsToRootTwo) {
  for (const Wavelet& wavelet : all_wavelets()) {
    double sum = 0.0;
    for (const double tap : wavelet.decompose_low) sum += tap;
    EXPECT_NEAR(sum, std::sqrt(2.0), kRounding) << wavelet.name;
  }
}

// pywt.Wavelet('db4') of PyWavelets 1.1.1, attributes dec_lo, dec_hi, rec_lo, rec_hi. Its digits
// are right to 1e-12 only.
TEST(Daubechies, IsOrientedAsPyWaveletsHasIt) {
  const std::vector<double> dec_lo{
      -0.010597401785069032, 0.0328830116668852, 0.030841381835560764, -0.18703481171909309,
      -0.027983769416859854, 0.6308807679298589, 0.7148465705529157,   0.2303778133088965};
  const std::vector<double> dec_hi{
      -0.2303778133088965, 0.7148465705529157,   -0.6308807679298589, -0.027983769416859854,
      0.18703481171909309, 0.030841381835560764, -0.0328830116668852, -0.010597401785069032};
  const Wavelet wavelet = daubechies("db4");
  EXPECT_THAT(wavelet.decompose_low, Pointwise(DoubleNear(1e-12), dec_lo));
  EXPECT_THAT(wavelet.decompose_high, Pointwise(DoubleNear(1e-12), dec_hi));
  EXPECT_THAT(std::vector<double>(wavelet.reconstruct_low.rbegin(), wavelet.reconstruct_low.rend()),
              Pointwise(DoubleNear(1e-12), dec_lo));
  EXPECT_THAT(
      std::vector<double>(wavelet.reconstruct_high.rbegin(), wavelet.reconstruct_high.rend()),
      Pointwise(DoubleNear(1e-12), dec_hi));
}

TEST(Daubechies, RefusesOtherNamesAndSaysWhatIsAccepted) {
  for (const char* name : {"", "db", "db0", "db01", "db20", "db4 ", "haar", "DB4"}) {
    try {
      daubechies(name);
      ADD_FAILURE() << "accepted '" << name << "'";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), HasSubstr("accepted: db1 ... db19"));
    }
  }
}

}  // namespace
}  // namespace slideway::daubechies_test
