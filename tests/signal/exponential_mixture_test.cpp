#include "slideway/signal/exponential_mixture.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <numeric>

#include "slideway/base/random.hpp"

namespace slideway::exponential_mixture_test {
namespace {

/// Memories from two values to four times a trace of n, a spectrum near f^-slope.
ExponentialMixture mixture(double white, double size, double slope, double n) {
  ExponentialMixture out;
  out.white = white;
  out.lengths = ExponentialMixture::spread_lengths(2.0, 4.0 * n);
  out.variances = out.lengths.pow(slope - 1.0);
  out.variances *= size / out.variances.sum();
  return out;
}

/// White noise; texture; 1/f noise beside white noise; a random walk with almost no white noise.
std::vector<ExponentialMixture> mixtures(double n) {
  ExponentialMixture texture = mixture(0.3, 1.0, 1.0, n);
  texture.variances.tail(ExponentialMixture::kTerms - 1).setZero();
  return {mixture(0.5, 0.0, 1.0, n), texture, mixture(1.0, 0.5, 1.0, n),
          mixture(1e-3, 5.0, 3.0, n)};
}

Eigen::MatrixXd dense(const ExponentialMixture& noise, const std::vector<double>& stations) {
  const auto n = static_cast<Eigen::Index>(stations.size());
  Eigen::MatrixXd out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      out(i, j) = i == j ? noise.variance() : noise.covariance(std::abs(stations[i] - stations[j]));
  return out;
}

/// Neighbours, but for a gap, values missing here and there, and a stretch of uneven steps.
std::vector<double> uneven_stations() {
  RandomStream random(1, "stations");
  std::vector<double> out;
  double at = 0.0;
  for (int i = 0; i < 300; ++i) {
    if (i == 100) at += 57.0;
    if (i > 150 && i < 200) at += random.uniform();
    if (random.uniform() > 0.05) out.push_back(at);
    at += 1.0;
  }
  return out;
}

std::vector<double> neighbours(std::size_t n) {
  std::vector<double> out(n);
  std::iota(out.begin(), out.end(), 0.0);
  return out;
}

Eigen::MatrixXd random_columns(Eigen::Index rows, Eigen::Index columns) {
  RandomStream random(2, "columns");
  Eigen::MatrixXd out(rows, columns);
  for (double& value : out.reshaped()) value = random.normal();
  return out;
}

constexpr double kRounding = 1e-10;  // of sums over some hundred rows, and of the dense factor

TEST(MixtureFactor, WhitensAsTheCholeskyFactorOfTheDenseCovarianceDoes) {
  for (const std::vector<double>& stations : {neighbours(257), uneven_stations()})
    for (const ExponentialMixture& noise : mixtures(static_cast<double>(stations.size()))) {
      const Eigen::LLT<Eigen::MatrixXd> root(dense(noise, stations));
      const MixtureFactor factor(noise, stations);
      const Eigen::MatrixXd columns = random_columns(factor.rows(), 11);
      Eigen::MatrixXd white = columns;
      factor.whiten(white);
      const Eigen::MatrixXd expected = root.matrixL().solve(columns);
      EXPECT_LT((white - expected).norm(), kRounding * expected.norm());
      const double log_determinant = 2.0 * root.matrixLLT().diagonal().array().log().sum();
      EXPECT_NEAR(factor.log_determinant(), log_determinant,
                  kRounding * static_cast<double>(stations.size()));
    }
}

TEST(MixtureFactor, ColoursWhatItHasWhitenedBackToTheValues) {
  const std::vector<double> stations = uneven_stations();
  for (const ExponentialMixture& noise : mixtures(static_cast<double>(stations.size()))) {
    const MixtureFactor factor(noise, stations);
    const Eigen::MatrixXd columns = random_columns(factor.rows(), 9);
    Eigen::MatrixXd back = columns;
    factor.whiten(back);
    factor.colour(back);
    EXPECT_LT((back - columns).norm(), kRounding * columns.norm());
  }
}

TEST(MixtureFactor, OfNeighboursIsThatOfStationsOneApart) {
  for (const ExponentialMixture& noise : mixtures(100.0)) {
    const MixtureFactor by_count(noise, 100), by_station(noise, neighbours(100));
    EXPECT_EQ(by_count.log_determinant(), by_station.log_determinant());
    Eigen::MatrixXd one = random_columns(100, 3), other = one;
    by_count.whiten(one);
    by_station.whiten(other);
    EXPECT_EQ(one, other);
  }
}

TEST(ExponentialMixture, IsTheBlockMeanOfAnExponentialCovariance) {
  // The double integral over two unit blocks, by the midpoint rule; its error falls with 1/m².
  constexpr int kPoints = 400;
  ExponentialMixture noise;
  noise.white = 0.0;
  noise.lengths[0] = 0.7;
  noise.variances[0] = 1.0;
  for (const int d : {0, 1, 3}) {
    double sum = 0.0;
    for (int i = 0; i < kPoints; ++i)
      for (int j = 0; j < kPoints; ++j)
        sum += std::exp(-std::abs(d + static_cast<double>(i - j) / kPoints) / 0.7);
    const double expected = sum / (kPoints * kPoints);
    EXPECT_NEAR(d == 0 ? noise.variance() : noise.covariance(d), expected, 1e-5);
  }
}

TEST(ExponentialMixture, SpectrumIsTheTransformOfTheCovariance) {
  const ExponentialMixture noise = mixture(0.4, 1.0, 1.5, 30.0);  // the longest memory: 120 values
  for (const double f : {0.0, 0.01, 0.2, 0.5}) {
    double sum = noise.variance();
    for (int d = 1; d < 6000; ++d)  // exp(-50) is left
      sum += 2.0 * noise.covariance(d) * std::cos(2.0 * std::numbers::pi * f * d);
    EXPECT_NEAR(noise.spectrum(f) / sum, 1.0, 1e-9) << f;
  }
}

TEST(ExponentialMixture, VarianceOfAMeanIsTheMeanOfTheCovariance) {
  constexpr std::size_t kValues = 50;
  for (const ExponentialMixture& noise : mixtures(kValues))
    EXPECT_NEAR(dense(noise, neighbours(kValues)).mean() / noise.variance_of_mean(kValues), 1.0,
                kRounding);
}

TEST(ExponentialMixture, WithWeightsOfAPowerHasASpectrumOfThatPower) {
  // Seven exponentials over three decades follow a power to a few per cent of its exponent.
  for (const double slope : {1.0, 1.5}) {
    const ExponentialMixture noise = mixture(0.0, 1.0, slope, 1000.0);
    const double found = std::log(noise.spectrum(1e-3) / noise.spectrum(1e-2)) / std::log(10.0);
    EXPECT_NEAR(found, slope, 0.08);
  }
}

}  // namespace
}  // namespace slideway::exponential_mixture_test
