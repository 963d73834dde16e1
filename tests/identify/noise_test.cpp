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
  for (const std::vector<double>& partial :
       {std::vector<double>{}, {0.8}, {0.7, -0.4}, {0.9, 0.2, 0.3}}) {
    Noise noise;
    noise.correlation = Autoregression(partial);
    noise.innovation = 0.3;
    const std::vector<double> rho = noise.correlation.autocorrelation(kRows);
    Eigen::MatrixXd covariance(kRows, kRows);
    for (int i = 0; i < kRows; ++i)
      for (int j = 0; j < kRows; ++j)
        covariance(i, j) = noise.standard_deviation() * noise.standard_deviation() *
                           rho[static_cast<std::size_t>(std::abs(i - j))];
    noise.whiten(covariance);
    covariance.transposeInPlace();
    noise.whiten(covariance);
    // Rounding of sums over 300 rows.
    EXPECT_LT((covariance - Eigen::MatrixXd::Identity(kRows, kRows)).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(Noise, OfFirstOrderIsRecovered) {
  constexpr double kPhi = 0.7, kInnovation = 2e-5;
  constexpr Eigen::Index kValues = 4000;
  const Noise noise = estimated(fitted(ar1(kValues, kPhi, kInnovation, 1), cosines(kValues, 5)));
  ASSERT_GE(noise.correlation.order(), 1);
  // Four standard errors: sqrt((1 - φ²) / n) of φ, sqrt(1 / 2n) of ln σ.
  const double n = static_cast<double>(kValues);
  EXPECT_NEAR(noise.correlation.predictor(1)[0], kPhi, 4.0 * std::sqrt((1.0 - kPhi * kPhi) / n));
  EXPECT_NEAR(std::log(noise.innovation / kInnovation), 0.0, 4.0 / std::sqrt(2.0 * n));
  // The same errors by the observed information: atanh φ has 1 / sqrt(n (1 - φ²)). They agree to
  // the errors' own relative error, a few times 1/sqrt(n).
  ASSERT_EQ(noise.covariance.rows(), noise.correlation.order() + 1);
  EXPECT_NEAR(std::sqrt(noise.covariance(0, 0)) * std::sqrt(n * (1.0 - kPhi * kPhi)), 1.0, 0.1);
  const Eigen::Index last = noise.covariance.rows() - 1;
  EXPECT_NEAR(std::sqrt(noise.covariance(last, last)) * std::sqrt(2.0 * n), 1.0, 0.1);
}

TEST(Noise, OfWhiteValuesHasNoOrder) {
  int whites = 0;
  constexpr int kRuns = 100;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed)
    whites += estimated(fitted(ar1(500, 0.0, 1.0, seed), cosines(500, 5))).correlation.order() == 0;
  // BIC takes one order too many with P(χ²_1 > ln 500) = 1.3 %, and higher ones rarely; a negative
  // correlation is not used. More than 8 of 100 would be a chance of 1e-5.
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

TEST(Noise, ThatAlternatesMakesNothingBetterKnown) {
  const Noise noise = estimated(fitted(ar1(2000, -0.6, 1.0, 2), cosines(2000, 5)));
  EXPECT_EQ(noise.correlation.order(), 0);
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
    EXPECT_EQ(noise.innovation, declared);
    EXPECT_EQ(noise.covariance.size(), 0);
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

TEST(Noise, OfTwoProfilesIsEachOnesOwn) {
  constexpr Eigen::Index kValues = 1000;
  const Eigen::MatrixXd columns = cosines(kValues, 3);
  const std::vector<LinearProfile> profiles{fitted(ar1(kValues, 0.0, 1.0, 5), columns),
                                            fitted(ar1(kValues, 0.8, 0.1, 6), columns)};
  const std::vector<Noise> noise = estimate_noise(profiles, Eigen::MatrixXd::Zero(3, 3));
  ASSERT_EQ(noise.size(), 2u);
  // Four standard errors of ln σ each.
  EXPECT_NEAR(std::log(noise[0].innovation), 0.0, 4.0 / std::sqrt(2.0 * kValues));
  EXPECT_NEAR(std::log(noise[1].innovation / 0.1), 0.0, 4.0 / std::sqrt(2.0 * kValues));
  // A mean of the second is as uncertain as that of white noise of σ / (1 - φ) = 0.5; 4 standard
  // errors: sqrt((1 - φ²)/n) / (1 - φ) of ln(1/(1 - φ)), and that of ln σ.
  EXPECT_NEAR(std::log(noise[1].long_run_deviation() / 0.5), 0.0,
              4.0 * std::sqrt(0.36 / kValues / 0.04 + 0.5 / kValues));
}

TEST(Noise, ThatHumsLongAgainstItsSamplingIsKnown) {
  // A decaying hum: φ1 = 2 ρ cos ω, φ2 = -ρ²; partial autocorrelations 0.9999 and -0.998.
  constexpr Eigen::Index kValues = 20000;
  constexpr double kDecay = 0.999, kOmega = 0.01;
  const double phi1 = 2.0 * kDecay * std::cos(kOmega), phi2 = -kDecay * kDecay;
  RandomStream random(7, "hum");
  Eigen::VectorXd values(kValues);
  double last = 0.0, before = 0.0;
  for (Eigen::Index t = -20000; t < kValues; ++t) {  // the start has died away by then
    const double next = phi1 * last + phi2 * before + random.normal();
    before = std::exchange(last, next);
    if (t >= 0) values[t] = next;
  }
  const Noise noise = estimated(fitted(values, cosines(kValues, 1)));
  // The variance of 20000 values with a memory of 1/(1 - ρ) = 1000 is known to a third; the
  // innovations to four times 1/sqrt(2n).
  EXPECT_NEAR(std::log(noise.standard_deviation() / std::sqrt(values.squaredNorm() / kValues)), 0.0,
              0.35);
  EXPECT_NEAR(std::log(noise.innovation), 0.0, 4.0 / std::sqrt(2.0 * kValues));
}

TEST(Noise, OfARandomWalkEndsAtALimitThatStillMakesASlopeAsUncertain) {
  constexpr Eigen::Index kValues = 150;
  Eigen::MatrixXd line(kValues, 2);
  for (Eigen::Index t = 0; t < kValues; ++t)
    line.row(t) << 1.0, static_cast<double>(t) - 0.5 * (kValues - 1);
  int at_limit = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, "walk");
    LinearProfile profile;
    profile.nuisances = Eigen::MatrixXd::Ones(kValues, 1);
    profile.columns.resize(kValues, 0);
    profile.residual.resize(kValues);
    double at = 0.0;
    for (double& value : profile.residual) value = at += random.normal();
    profile.residual.array() -= profile.residual.mean();
    const Noise noise = estimated(profile);
    const double length = noise.correlation.long_run_ratio() / (8.0 * kValues);
    EXPECT_LE(length, 1.0 + 1e-9);  // rounding
    if (length < 1.0 - 1e-9) continue;
    ++at_limit;
    // Across the limit nothing is estimated: what is left is the innovation, 1/sqrt(2n), and that
    // to a few times its own relative error.
    const Eigen::VectorXd spread = noise.covariance.diagonal().cwiseSqrt();
    EXPECT_NEAR(spread[spread.size() - 1] * std::sqrt(2.0 * kValues), 1.0, 0.2);
    if (noise.correlation.order() > 1) continue;
    EXPECT_EQ(spread[0], 0.0);
    Eigen::MatrixXd white = line;
    noise.whiten(white);
    const double variance = (white.transpose() * white).inverse()(1, 1);
    // The increments of a walk are independent: the slope is their mean.
    const double ratio = std::sqrt(variance * (kValues - 1)) / noise.innovation;
    EXPECT_NEAR(ratio, 0.942, 0.005);  // by inverting both covariances in NumPy: 0.942
  }
  EXPECT_GE(at_limit, 3);  // about half of such walks look like walks
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

}  // namespace
}  // namespace slideway
