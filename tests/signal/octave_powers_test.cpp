#include "slideway/signal/octave_powers.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "slideway/base/random.hpp"

namespace slideway {
namespace {

constexpr int kSegment = 64;

/// White noise, texture and a memory of many lengths.
ExponentialMixture mixture() {
  ExponentialMixture out;
  out.white = 0.2;
  out.lengths = ExponentialMixture::spread_lengths(1.5, 4000.0);
  out.variances = 0.1 * out.lengths.sqrt();
  return out;
}

/// cos(π j (s + 1/2) / 64) of unit length, each value `times` times.
Eigen::VectorXd cosine(int j, int times) {
  Eigen::VectorXd out(kSegment * times);
  for (Eigen::Index s = 0; s < out.size(); ++s)
    out[s] = std::sqrt(2.0 / kSegment) *
             std::cos(std::numbers::pi * j * (static_cast<double>(s / times) + 0.5) / kSegment);
  return out;
}

/// Variance of a cosine of means of so many values, by the covariance of each pair of them.
double variance_of(int j, int times, const ExponentialMixture& noise) {
  Eigen::MatrixXd covariance(kSegment * times, kSegment * times);
  for (Eigen::Index a = 0; a < covariance.rows(); ++a)
    for (Eigen::Index b = 0; b < covariance.cols(); ++b)
      covariance(a, b) =
          a == b ? noise.variance() : noise.covariance(std::abs(static_cast<double>(a - b)));
  const Eigen::VectorXd weights = cosine(j, times) / times;
  return weights.dot(covariance * weights);
}

TEST(OctavePowers, KnowsTheVarianceOfEachCosineOfEachOctave) {
  for (const int j : {32, 47, 63}) {
    // At the first octave there is the cosine alone; it is squared over its variance.
    const OctavePowers fine(cosine(j, 1), {{0, kSegment}}, 1);
    EXPECT_NEAR(fine.under(mixture()).square, 1.0 / variance_of(j, 1, mixture()), 1e-9) << j;
    // Means of four: the octaves before see steps, which white noise weighs alike.
    ExponentialMixture white;
    const OctavePowers coarse(cosine(j, 4), {{0, 4 * kSegment}}, 3);
    const OctavePowers before(cosine(j, 4), {{0, 4 * kSegment}}, 2);
    EXPECT_NEAR(coarse.under(white).square - before.under(white).square, 4.0, 1e-9) << j;
    EXPECT_NEAR(coarse.under(mixture()).square - before.under(mixture()).square,
                1.0 / variance_of(j, 4, mixture()), 1e-9)
        << j;
  }
}

TEST(OctavePowers, HoldsANumberForEachValueButTheMeans) {
  const OctavePowers powers(Eigen::VectorXd::Zero(4096), {{0, 4096}}, 3);
  EXPECT_EQ(powers.count(), 4096.0 - 4096.0 / 8.0);
}

TEST(BlockMeans, AreOfNeighboursInEachRun) {
  const Eigen::VectorXd rows = Eigen::VectorXd::LinSpaced(11, 0.0, 10.0);
  const Eigen::VectorXd expected{{0.5, 2.5, 5.5, 7.5}};
  EXPECT_EQ(block_means(rows, {{0, 5}, {5, 5}}, 1), expected);
}

// The mean of -2 ln L over noise is least at the noise itself; where one parameter is off by a
// hundredth, 64000 values tell it apart by (0.01)² 64000 / 4, of which a part is expected here.
TEST(OctavePowers, AreLikeliestUnderTheNoiseTheyAreOf) {
  constexpr Eigen::Index kMany = 65536;
  RandomStream random(4, "octaves");
  Eigen::VectorXd series(kMany);
  const double rho = std::exp(-1.0 / 8.0);
  double state = random.normal();
  for (double& value : series) {
    value = state + random.normal();
    state = rho * state + std::sqrt(1.0 - rho * rho) * random.normal();
  }
  const OctavePowers powers(series, {{0, kMany}}, 6);
  // Correlation exp(-d / length) of values of variance 1, beside white noise.
  const auto cost = [&](double white, double length) {
    ExponentialMixture noise;
    noise.white = 0.0;
    noise.lengths[0] = length;
    noise.variances[0] = 1.0;
    noise.variances[0] = std::exp(-1.0 / length) / noise.covariance(1.0);
    noise.white = 1.0 + white - noise.variance();
    const OctavePowers::Fit fit = powers.under(noise);
    return fit.log_determinant + fit.square;
  };
  EXPECT_LT(cost(1.0, 8.0), cost(1.1, 8.0));
  EXPECT_LT(cost(1.0, 8.0), cost(0.9, 8.0));
  EXPECT_LT(cost(1.0, 8.0), cost(1.0, 10.0));
  EXPECT_LT(cost(1.0, 8.0), cost(1.0, 6.4));
}

}  // namespace
}  // namespace slideway
