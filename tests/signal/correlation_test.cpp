#include "slideway/signal/correlation.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "signal/noise.hpp"
#include "slideway/base/text.hpp"
#include "support/measured_data.hpp"

namespace slideway::correlation_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

std::vector<double> first_order(std::size_t n, double phi, std::string_view stream) {
  std::vector<double> x = white_noise(n, stream);
  x[0] /= std::sqrt(1.0 - phi * phi);
  for (std::size_t t = 1; t < n; ++t) x[t] += phi * x[t - 1];
  return x;
}

std::vector<double> slope(std::size_t n) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = 0.1 * static_cast<double>(i);
  return x;
}

// Anscombe (1973), The American Statistician 27, 17: four data sets of r = 0.816. Of the first,
// Sxx = 110, Sxy = 55.01 and Syy = 41.2726909... follow exactly.
const std::vector<double> kAnscombeX{10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
const std::vector<double> kAnscombeY{8.04, 6.95, 7.58,  8.81, 8.33, 9.96,
                                     7.24, 4.26, 10.84, 4.82, 5.68};

TEST(Pearson, AgreesWithAnscombesFirstSet) {
  EXPECT_NEAR(pearson(kAnscombeX, kAnscombeY), 0.816, 0.0005);  // as published
  EXPECT_NEAR(pearson(kAnscombeX, kAnscombeY), 55.01 / std::sqrt(110.0 * 41.2726909090909090),
              1e-14);
}

// NIST StRD, linear regression "Norris": certified R-squared, 15 digits.
TEST(Pearson, SquaredIsTheCertifiedValueOfNorris) {
  const auto path = measured_data() / "nist_strd_linear/norris.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
  std::ifstream file(path);
  std::vector<double> x, y;
  for (std::string line; std::getline(file, line);) {
    const auto comma = line.find(',');
    if (comma == std::string::npos || line.starts_with('#')) continue;
    const auto first = parse_double(std::string_view(line).substr(0, comma));
    const auto second = parse_double(std::string_view(line).substr(comma + 1));
    if (!first || !second) continue;  // the header
    x.push_back(*first);
    y.push_back(*second);
  }
  ASSERT_EQ(x.size(), 36u);
  EXPECT_NEAR(pearson(x, y) * pearson(x, y), 0.999993745883712, 1e-14);
}

TEST(Pearson, IsUnmovedByAHugeMean) {
  // Multiples of 1/1024: adding 2^40 is exact, so the coefficient must not change.
  std::vector<double> x = white_noise(1000, "x");
  std::vector<double> y = white_noise(1000, "y");
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = std::round(1024.0 * x[i]) / 1024.0;
    y[i] = x[i] + std::round(1024.0 * y[i]) / 1024.0;
  }
  const double r = pearson(x, y);
  for (double& value : x) value += 0x1p40;
  for (double& value : y) value -= 0x1p40;
  EXPECT_NEAR(pearson(x, y), r, 1e-13);  // rounding of a thousand products
  EXPECT_NEAR(running_pearson(x, y, 1).coefficient[0], r, 1e-13);
}

TEST(Pearson, IsUnmovedByScaleAndTurnsWithSign) {
  std::vector<double> scaled = kAnscombeY;
  for (double& value : scaled) value = -1e-9 * value + 3.0;
  // 3.0 leaves 1e-9 only 7 digits.
  EXPECT_NEAR(pearson(kAnscombeX, scaled), -pearson(kAnscombeX, kAnscombeY), 1e-6);
  EXPECT_DOUBLE_EQ(pearson(kAnscombeY, kAnscombeX), pearson(kAnscombeX, kAnscombeY));
  EXPECT_NEAR(pearson(kAnscombeX, kAnscombeX), 1.0, 1e-15);
}

TEST(Pearson, NothingCorrelatesWithAConstant) {
  const std::vector<double> x = white_noise(1000, "x");
  EXPECT_EQ(pearson(x, std::vector<double>(1000, 0.1)), 0.0);
  std::vector<double> rounding(1000, 0.1);
  rounding[500] = std::nextafter(0.1, 1.0);
  EXPECT_EQ(pearson(x, rounding), 0.0);
  EXPECT_EQ(running_pearson(x, rounding, 1).coefficient[0], 0.0);
  EXPECT_EQ(pearson({}, {}), 0.0);
  EXPECT_EQ(pearson(std::vector{1.0}, std::vector{2.0}), 0.0);
}

TEST(RunningPearson, IsPearsonOfTheFirstSamples) {
  const std::vector<double> x = first_order(1003, 0.8, "x");
  const std::vector<double> y = first_order(1003, 0.9, "y");
  const RunningCoefficient running = running_pearson(x, y, 10);
  EXPECT_THAT(running.samples, ElementsAre(100, 200, 300, 401, 501, 601, 702, 802, 902, 1003));
  for (std::size_t k = 0; k < running.samples.size(); ++k) {
    const std::size_t n = running.samples[k];
    EXPECT_NEAR(running.coefficient[k], pearson(std::span(x).first(n), std::span(y).first(n)),
                1e-13);  // rounding of a thousand updates
  }
}

TEST(RunningPearson, GivesNoMorePointsThanSamples) {
  EXPECT_THAT(running_pearson(kAnscombeX, kAnscombeY, 1000).samples,
              ElementsAre(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11));
  EXPECT_TRUE(running_pearson({}, std::span<const double>(), 5).samples.empty());
}

TEST(BestLag, FindsByHowMuchTheSecondComesLater) {
  const std::vector<double> all = first_order(600, 0.7, "lag");
  const std::span<const double> span(all);
  for (const int lag : {0, 7, -13}) {
    // y[i + lag] = -x[i]
    std::vector<double> y(span.begin() + 50 - lag, span.begin() + 550 - lag);
    for (double& value : y) value = -value;
    const Lag found = best_lag(span.subspan(50, 500), y, 40);
    EXPECT_EQ(found.lag, lag);
    EXPECT_NEAR(found.coefficient, -1.0, 1e-12);  // running sums of 500 squares
  }
}

TEST(BestLag, CoefficientIsPearsonOverTheOverlap) {
  std::vector<double> x = first_order(300, 0.9, "x");
  std::vector<double> y = first_order(300, 0.9, "y");
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] += 0.05 * static_cast<double>(i);
    y[i] += 1e6;
  }
  const std::span<const double> sx(x), sy(y);
  Lag expected{0, pearson(x, y)};
  for (int lag = 1; lag <= 60; ++lag) {
    const std::size_t n = x.size() - static_cast<std::size_t>(lag);
    const double later = pearson(sx.first(n), sy.last(n));
    if (std::abs(later) > std::abs(expected.coefficient)) expected = {lag, later};
    const double sooner = pearson(sx.last(n), sy.first(n));
    if (std::abs(sooner) > std::abs(expected.coefficient)) expected = {-lag, sooner};
  }
  const Lag found = best_lag(x, y, 60);
  EXPECT_EQ(found.lag, expected.lag);
  EXPECT_NEAR(found.coefficient, expected.coefficient, 1e-10);  // y has 10 digits left
}

TEST(BestLag, TheSmallerLagWinsATie) {
  std::vector<double> x(100);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = i % 4 < 2 ? 1.0 : -1.0;  // period 4
  EXPECT_EQ(best_lag(x, x, 20).lag, 0);
}

TEST(BestLag, OfAConstantOrOfTooFewSamplesIsNone) {
  const std::vector<double> constant(50, 0.1);
  const Lag none = best_lag(constant, slope(50), 10);
  EXPECT_EQ(none.lag, 0);
  EXPECT_EQ(none.coefficient, 0.0);
  EXPECT_EQ(best_lag(std::vector{1.0, 2.0}, std::vector{1.0, 2.0}, 10).coefficient, 0.0);
}

TEST(Autocorrelation, OfAnAlternatingSeriesIsKnown) {
  const std::vector<double> x{1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0};
  const std::vector<double> r = autocorrelation(x, 9);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(r[k], (k % 2 == 0 ? 1.0 : -1.0) * (8.0 - static_cast<double>(k)) / 8.0, 1e-15);
  EXPECT_EQ(r[8], 0.0);  // beyond the series
  EXPECT_THAT(autocorrelation(std::vector<double>(5, 0.1), 2), ElementsAre(1.0, 0.0, 0.0));
}

// Bartlett's formula written out, without shortcuts.
double bartlett(const std::vector<double>& x, const std::vector<double>& y) {
  const int last = static_cast<int>(x.size()) - 1;
  const std::vector<double> rx = autocorrelation(x, last);
  const std::vector<double> ry = autocorrelation(y, last);
  const double n = static_cast<double>(x.size());
  double sum = 0.0;
  for (std::size_t k = 1; k < x.size() && rx[k] * ry[k] > 0.0; ++k)
    sum += (1.0 - static_cast<double>(k) / n) * rx[k] * ry[k];
  return n / (1.0 + 2.0 * sum);
}

TEST(EffectiveObservations, IsBartlettsFormulaAtShortAndLongMemory) {
  for (const double phi : {0.3, 0.9, 0.995})
    for (const std::size_t n : {40u, 300u, 3000u}) {
      const std::vector<double> x = first_order(n, phi, "x");
      const std::vector<double> trend = slope(n);
      // Rounding of lagged products, by direct sums or by the transform.
      EXPECT_NEAR(effective_observations(x, x) / std::max(3.0, bartlett(x, x)), 1.0, 1e-10);
      EXPECT_NEAR(effective_observations(x, trend) / std::max(3.0, bartlett(x, trend)), 1.0, 1e-10);
      EXPECT_NEAR(effective_observations(trend, trend) / std::max(3.0, bartlett(trend, trend)), 1.0,
                  1e-10);
    }
}

// Beyond lag 36 eight lags share the product at their centre, half a lag off and smoothed over
// fifteen: of a memory of 100 values that is below 1 % of the sum.
TEST(EffectiveObservations, OfALongSeriesIsBartlettsFormulaForMeansAtLongLags) {
  constexpr std::size_t kSamples = 20'000;
  const std::vector<double> trend = slope(kSamples);
  std::vector<double> noisy = white_noise(kSamples, "noisy");
  for (std::size_t i = 0; i < kSamples; ++i) noisy[i] += 0.0002 * static_cast<double>(i);
  for (const auto& x : {trend, noisy, first_order(kSamples, 0.99, "x")}) {
    EXPECT_NEAR(effective_observations(x, x) / std::max(3.0, bartlett(x, x)), 1.0, 0.01);
    EXPECT_NEAR(effective_observations(x, trend) / std::max(3.0, bartlett(x, trend)), 1.0, 0.01);
  }
}

TEST(EffectiveObservations, OfFirstOrderSeriesTendsToTheKnownShare) {
  constexpr std::size_t kSamples = 100'000;
  const std::vector<double> x = first_order(kSamples, 0.8, "first");
  const std::vector<double> y = first_order(kSamples, 0.7, "second");
  // Σ r_x r_y = Σ (φ ψ)^k: N (1 - φψ) / (1 + φψ) (Bartlett 1935). Each r is known to 0.01 and some
  // ten lags matter, with errors alike: 5 %, false alarm well below 1 in 1000.
  EXPECT_NEAR(effective_observations(x, y) / kSamples, (1.0 - 0.56) / (1.0 + 0.56), 0.05 * 0.28);
}

TEST(EffectiveObservations, StaysBetweenThreeAndAll) {
  const std::vector<double> alternating{1.0, -1.0, 1.0, -1.0, 1.0, -1.0};
  for (const auto& x : {alternating, slope(3), slope(6), slope(100), white_noise(6, "six")}) {
    EXPECT_GE(effective_observations(x, x), 3.0);
    EXPECT_LE(effective_observations(x, x), static_cast<double>(x.size()));
  }
  EXPECT_EQ(effective_observations(slope(100), std::vector<double>(100, 0.1)), 100.0);
}

// Two-sided p by scipy 1.10: t = |r| sqrt((n - 2) / (1 - r^2)); 2 * scipy.stats.t.sf(t, n - 2).
TEST(CorrelationPValue, AgreesWithScipy) {
  const std::vector<std::array<double, 3>> expected{{0.6319, 10.0, 0.04999851335664685},
                                                    {0.8, 5.0, 0.10408803866182778},
                                                    {0.1, 400.5, 0.045499156153815494},
                                                    {-0.3, 50.0, 0.03428618003292995},
                                                    {0.95, 140.0, 1.2430086208429641e-71}};
  for (const auto& [r, n, p] : expected)
    EXPECT_NEAR(correlation_p_value(r, n) / p, 1.0, 1e-11) << r << ' ' << n;  // the tail's slope
}

TEST(CorrelationPValue, IsOneForNoCorrelationAndZeroForPerfect) {
  EXPECT_EQ(correlation_p_value(0.0, 20.0), 1.0);
  EXPECT_EQ(correlation_p_value(1.0, 20.0), 0.0);
  EXPECT_EQ(correlation_p_value(-1.0, 20.0), 0.0);
  EXPECT_EQ(correlation_p_value(0.9, 2.0), 1.0);
}

}  // namespace
}  // namespace slideway::correlation_test
