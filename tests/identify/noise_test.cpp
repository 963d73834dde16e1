#include "slideway/identify/noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/uncertainty.hpp"

namespace slideway {
namespace {

/// Stationary AR(1) with innovations of standard deviation 1, scaled.
Eigen::VectorXd ar1(Eigen::Index n, double phi, double innovation, std::uint64_t seed) {
  RandomStream random(seed, "ar1");
  Eigen::VectorXd out(n);
  double state = random.normal() / std::sqrt(1.0 - phi * phi);
  for (Eigen::Index t = 0; t < n; ++t) {
    if (t > 0) state = phi * state + random.normal();
    out[t] = innovation * state;
  }
  return out;
}

/// Cosines: smooth, nearly orthogonal columns.
Eigen::MatrixXd cosines(Eigen::Index n, Eigen::Index count) {
  Eigen::MatrixXd out(n, count);
  for (Eigen::Index t = 0; t < n; ++t)
    for (Eigen::Index j = 0; j < count; ++j)
      out(t, j) = std::cos(3.141592653589793 * static_cast<double>(j) *
                           (static_cast<double>(t) + 0.5) / static_cast<double>(n));
  return out;
}

/// What a least-squares fit of the columns leaves of the values.
LinearProfile fitted(const Eigen::VectorXd& values, const Eigen::MatrixXd& columns) {
  LinearProfile out;
  out.nuisances.resize(values.size(), 0);
  out.columns = columns;
  out.residual = values - columns * columns.householderQr().solve(values).eval();
  return out;
}

Noise estimated(const LinearProfile& profile) {
  const Eigen::Index r = profile.columns.cols();
  return estimate_noise({&profile, 1}, Eigen::MatrixXd::Zero(r, r)).front();
}

TEST(Noise, WhitensItsCovarianceToTheUnitMatrix) {
  constexpr int kRows = 300;
  ExponentialMixture covariance;
  covariance.white = 0.1;
  covariance.lengths = ExponentialMixture::spread_lengths(2.0, 4.0 * kRows);
  covariance.variances.setConstant(0.3);
  Eigen::MatrixXd rows(kRows, kRows);
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kRows; ++j)
      rows(i, j) = i == j ? covariance.variance() : covariance.covariance(std::abs(i - j));
  const Noise noise(covariance, kRows);
  noise.whiten(rows);
  rows.transposeInPlace();
  noise.whiten(rows);
  // Rounding of sums over 300 rows.
  EXPECT_LT((rows - Eigen::MatrixXd::Identity(kRows, kRows)).cwiseAbs().maxCoeff(), 1e-11);
}

// E[s²] of n values about their mean: the trace of the covariance less its mean, over n - 1.
TEST(Noise, StandardDeviationIsThatOfValuesAboutTheirMean) {
  constexpr int kRows = 8;
  ExponentialMixture covariance;
  covariance.white = 0.1;
  covariance.lengths = ExponentialMixture::spread_lengths(2.0, 4.0 * kRows);
  covariance.variances.setConstant(0.3);
  const Noise noise(covariance, kRows);
  double trace = 0.0, sum = 0.0;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kRows; ++j) {
      const double each = i == j ? covariance.variance() : covariance.covariance(std::abs(i - j));
      sum += each;
      trace += i == j ? each : 0.0;
    }
  const double expected = std::sqrt((trace - sum / kRows) / (kRows - 1));
  EXPECT_NEAR(noise.standard_deviation(), expected, 1e-9);
  EXPECT_NEAR(noise.repeated({4.0, 1.0}).standard_deviation(), expected, 1e-9);
}

TEST(Noise, OfFirstOrderIsRecovered) {
  constexpr double kPhi = 0.7, kInnovation = 2e-5;
  constexpr Eigen::Index kValues = 4000;
  const Noise noise = estimated(fitted(ar1(kValues, kPhi, kInnovation, 1), cosines(kValues, 5)));
  // Four standard errors of an AR(1)'s variance, (1 + φ²)/(1 - φ²) 2/n.
  const double square = kPhi * kPhi, n = static_cast<double>(kValues);
  EXPECT_NEAR(2.0 * std::log(noise.standard_deviation() * std::sqrt(1.0 - square) / kInnovation),
              0.0, 4.0 * std::sqrt(2.0 / n * (1.0 + square) / (1.0 - square)));
  // Between two lengths a factor of 2 apart the long-run variance is off by up to 2.
  EXPECT_NEAR(2.0 * std::log(noise.long_run_deviation() * (1.0 - kPhi) / kInnovation), 0.0,
              std::log(2.0));
}

TEST(Noise, OfWhiteValuesIsWhite) {
  int whites = 0;
  constexpr int kRuns = 100;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed)
    whites += estimated(fitted(ar1(500, 0.0, 1.0, seed), cosines(500, 5))).is_white() ? 1 : 0;
  // Memories of any kind are a priori three to one: of 54 and 45 kinds the best of noise alone
  // seldom gains the factor that pays for the choice.
  EXPECT_GE(whites, kRuns - 8);
}

TEST(Noise, VarianceCountsTheParametersTaken) {
  // 40 values, 15 parameters: maximum likelihood would find 25/40 of the variance.
  constexpr int kRuns = 400, kValues = 40, kParameters = 15;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const Noise noise =
        estimated(fitted(ar1(kValues, 0.0, 1.0, seed), cosines(kValues, kParameters)));
    sum += noise.standard_deviation() * noise.standard_deviation();
  }
  // Four standard errors of the mean: sqrt(2 / 25 / 400).
  EXPECT_NEAR(sum / kRuns, 1.0, 4.0 * std::sqrt(2.0 / (kValues - kParameters) / kRuns));
}

TEST(Noise, IsTheSameWhereWhatHasPriorsIsAnErrorOfKnownSize) {
  // v of unit covariance beside w: a prior of w that is nowhere else (Harville 1974).
  constexpr Eigen::Index kValues = 120, kColumns = 9, kBounded = 6;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Eigen::VectorXd values = ar1(kValues, seed < 2 ? 0.0 : 0.9, 1.0, seed);
    Eigen::MatrixXd columns = cosines(kValues, kColumns);
    for (Eigen::Index j = 0; j < kBounded; ++j) columns.col(j) *= 0.05 * std::pow(4.0, j);
    LinearProfile with_priors{Eigen::MatrixXd(kValues, 0), columns, values, std::nullopt};
    Eigen::MatrixXd priors = Eigen::MatrixXd::Zero(kColumns, kColumns);
    priors.diagonal().head(kBounded).setOnes();
    LinearProfile bounded{Eigen::MatrixXd(kValues, 0), columns.rightCols(kColumns - kBounded),
                          values, std::nullopt};
    bounded.bounded = columns.leftCols(kBounded);
    constexpr Eigen::Index kOthers = kColumns - kBounded;
    const Noise expected = estimate_noise({&with_priors, 1}, priors).front();
    const Noise found =
        estimate_noise({&bounded, 1}, Eigen::MatrixXd::Zero(kOthers, kOthers)).front();
    // Sizes settle to 1e-6.
    EXPECT_NEAR(found.standard_deviation() / expected.standard_deviation(), 1.0, 1e-5);
    EXPECT_NEAR(found.long_run_deviation() / expected.long_run_deviation(), 1.0, 1e-5);
    EXPECT_NEAR(found.freedom / expected.freedom, 1.0, 1e-5);
    ASSERT_EQ(found.alternatives.size(), expected.alternatives.size());
    for (std::size_t k = 0; k < found.alternatives.size(); ++k)
      EXPECT_NEAR(found.alternatives[k].probability, expected.alternatives[k].probability, 1e-4);
  }
}

TEST(Noise, ThatAlternatesMakesNothingBetterKnown) {
  const Noise noise = estimated(fitted(ar1(2000, -0.6, 1.0, 2), cosines(2000, 5)));
  EXPECT_TRUE(noise.is_white());
  // Var(e) = 1 / (1 - φ²), to four standard errors of an AR(1)'s variance (1 + φ²)/(1 - φ²) 2/n.
  const double expected = 1.0 / (1.0 - 0.36);
  EXPECT_NEAR(noise.standard_deviation() * noise.standard_deviation() / expected, 1.0,
              4.0 * std::sqrt(2.0 / 2000.0 * 1.36 / 0.64));
}

TEST(Noise, DeclaredStandsUnlessTheResidualRefutesIt) {
  LinearProfile profile = fitted(ar1(500, 0.0, 1.0, 3), cosines(500, 5));
  for (const double declared : {1.0, 1.05, 3.0}) {  // right, a little and much too large
    profile.declared = declared;
    const Noise noise = estimated(profile);
    EXPECT_TRUE(noise.declared) << declared;
    EXPECT_FALSE(noise.overruled) << declared;
    EXPECT_EQ(noise.standard_deviation(), declared);
    EXPECT_FALSE(noise.is_estimated());
  }
  profile.declared = 0.5;
  const Noise refuted = estimated(profile);
  EXPECT_TRUE(refuted.overruled);
  EXPECT_FALSE(refuted.declared);
  // Four standard errors of ln σ from 495 degrees of freedom.
  EXPECT_NEAR(std::log(refuted.standard_deviation()), 0.0, 4.0 / std::sqrt(2.0 * 495.0));
  LinearProfile correlated = fitted(ar1(500, 0.9, 1.0, 4), cosines(500, 5));
  correlated.declared = 1.0 / std::sqrt(1.0 - 0.81);  // the right size, but it is not white
  EXPECT_TRUE(estimated(correlated).overruled);
}

TEST(Noise, OfTwoPoolsIsEachOnesOwn) {
  constexpr Eigen::Index kValues = 1000;
  const Eigen::MatrixXd columns = cosines(kValues, 3);
  std::vector<LinearProfile> profiles{fitted(ar1(kValues, 0.0, 1.0, 5), columns),
                                      fitted(ar1(kValues, 0.8, 0.1, 6), columns)};
  profiles[1].pool = 1;
  const std::vector<Noise> noise = estimate_noise(profiles, Eigen::MatrixXd::Zero(3, 3));
  ASSERT_EQ(noise.size(), 2u);
  EXPECT_TRUE(noise[0].is_white());
  // Four standard errors of ln σ.
  EXPECT_NEAR(std::log(noise[0].standard_deviation()), 0.0, 4.0 / std::sqrt(2.0 * kValues));
  // A mean of the second is as uncertain as that of white noise of σ / (1 - φ) = 0.5; lengths are a
  // factor of 2 apart.
  EXPECT_NEAR(std::log(noise[1].long_run_deviation() / 0.5), 0.0, 0.5 * std::log(2.0));
}

TEST(Noise, OfOnePoolHasOneMemoryAndItsOwnSizes) {
  constexpr Eigen::Index kValues = 500;
  const Eigen::MatrixXd columns = cosines(kValues, 3);
  std::vector<LinearProfile> profiles;
  for (const double size : {1.0, 1.5, 10.0})
    profiles.push_back(fitted(ar1(kValues, 0.8, size, 7 + profiles.size()), columns));
  const std::vector<Noise> noise = estimate_noise(profiles, Eigen::MatrixXd::Zero(3, 3));
  for (const std::size_t i : {1, 2}) {
    const double size = noise[i].covariance().white / noise[0].covariance().white;
    EXPECT_NEAR(noise[i].covariance().variances[0] / noise[0].covariance().variances[0] / size, 1.0,
                1e-9);
    // Four standard errors of ln σ of two profiles of innovations.
    EXPECT_NEAR(0.5 * std::log(size), std::log(i == 1 ? 1.5 : 10.0),
                4.0 * std::sqrt(1.0 / kValues));
  }
  EXPECT_FALSE(noise[0].unlike_sisters || noise[1].unlike_sisters);
  ASSERT_TRUE(noise[2].unlike_sisters);
  EXPECT_NEAR(*noise[2].unlike_sisters, 10.0 / std::sqrt(1.5), 1.5);
}

TEST(Noise, OfValuesWithGapsIsThatOfTheWhole) {
  constexpr Eigen::Index kValues = 2000;
  const LinearProfile whole = fitted(ar1(kValues, 0.8, 1.0, 11), cosines(kValues, 3));
  LinearProfile part;
  std::vector<Eigen::Index> rows;
  RandomStream random(12, "gaps");
  for (Eigen::Index i = 0; i < kValues; ++i)
    if ((i < 500 || i > 700) && random.uniform() > 0.02) rows.push_back(i);
  part.nuisances.resize(std::ssize(rows), 0);
  part.columns = whole.columns(rows, Eigen::all);
  part.residual = whole.residual(rows);
  part.stations.assign(rows.begin(), rows.end());
  part.values = kValues;
  // One value in ten is not seen: the estimates share the others, and the lattice.
  EXPECT_NEAR(
      std::log(estimated(part).long_run_deviation() / estimated(whole).long_run_deviation()), 0.0,
      0.5 * std::log(2.0));
}

TEST(Uncertainty, OfAWeightedMeanCountsThatItsWeightsComeFromTheData) {
  // Two series of 16 values, one mean. Weights taken at their word make its variance too small by
  // 1 + 4 Σ w (1 - w) / 15 = 1.13 (Meier 1953).
  constexpr int kRuns = 4000, kValues = 16;
  const Problem problem = cases::problem(Lever::paper, 0, {cases::effect("straightness", 0)});
  double claimed = 0.0, actual = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "weighted mean");
    std::vector<Profile> profiles;
    for (const char* name : {"a", "b"}) {
      std::vector<double> values(kValues);
      for (double& value : values) value = random.normal();
      profiles.push_back(
          cases::profile(name, Kind::slide, cases::spaced(0.0, 15.0, kValues), values));
      profiles.back().free_offset = profiles.back().free_tilt = false;
    }
    const Model model = build_model(problem, profiles);
    const Solution result = fit(model);
    const double u = result.uncertainty.of(result.parameters.jacobian.row(0)).standard_uncertainty;
    claimed += u * u / kRuns;
    actual += result.parameters.values[0] * result.parameters.values[0] / kRuns;
  }
  // Four standard errors of a variance from 4000 means.
  EXPECT_NEAR(claimed / actual, 1.0, 4.0 * std::sqrt(2.0 / kRuns));
}

TEST(CoverageFactor, IsTheOneOfTheGuide) {
  // GUM, table G.2, column 95.45 %.
  EXPECT_NEAR(coverage_factor(1.0), 13.97, 0.005);
  EXPECT_NEAR(coverage_factor(2.0), 4.53, 0.005);
  EXPECT_NEAR(coverage_factor(5.0), 2.65, 0.005);
  EXPECT_NEAR(coverage_factor(10.0), 2.28, 0.005);
  EXPECT_NEAR(coverage_factor(50.0), 2.05, 0.005);
  EXPECT_EQ(coverage_factor(std::nullopt), 2.0);
}

// A column that is as fast as the values keeps a long profile from being asked by its block means:
// both ways see the same residual. A hundredth of the long-run deviation is a hundredth of U.
TEST(Noise, OfALongProfileIsThatOfAllItsRows) {
  constexpr Eigen::Index kValues = 20000;
  const Eigen::MatrixXd slow = cosines(kValues, 6);
  Eigen::MatrixXd with_fast(kValues, 7);
  for (Eigen::Index t = 0; t < kValues; ++t) with_fast(t, 6) = t % 2 == 0 ? 1.0 : -1.0;
  with_fast.leftCols(6) = slow;
  RandomStream white(40, "white");
  for (const double length : {1.0, 5.0, 40.0, 4000.0}) {
    Eigen::VectorXd values = ar1(kValues, std::exp(-1.0 / length), 1.0, 41);
    for (double& value : values) value += 2.0 * white.normal();
    LinearProfile exact = fitted(values, with_fast), quick = exact;
    quick.columns = slow;
    const Noise of_all = estimated(exact), of_means = estimated(quick);
    EXPECT_NEAR(of_means.long_run_deviation(), of_all.long_run_deviation(),
                0.01 * of_all.long_run_deviation())
        << length;
    EXPECT_NEAR(of_means.standard_deviation(), of_all.standard_deviation(),
                0.01 * of_all.standard_deviation())
        << length;
  }
}

}  // namespace
}  // namespace slideway
