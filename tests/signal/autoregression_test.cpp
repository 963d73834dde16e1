#include "slideway/signal/autoregression.hpp"

#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>

#include "signal/noise.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Pointwise;

const std::vector<std::vector<double>> kPartials{
    {}, {0.7}, {-0.4}, {0.6, -0.3}, {0.9, 0.5, -0.2, 0.1}, {0.99, -0.95, 0.9}};

// Covariance of n samples of noise whose innovations have unit variance, from its autocorrelation.
Eigen::MatrixXd covariance(const Autoregression& noise, int n) {
  const std::vector<double> rho = noise.autocorrelation(n - 1);
  Eigen::MatrixXd matrix(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) matrix(i, j) = noise.variance_ratio() * rho[std::abs(i - j)];
  return matrix;
}

std::vector<double> second_order(std::size_t n, double phi1, double phi2) {
  constexpr std::size_t kRunIn = 500;
  std::vector<double> e = white_noise(n + kRunIn, "second order");
  for (std::size_t t = 2; t < e.size(); ++t) e[t] += phi1 * e[t - 1] + phi2 * e[t - 2];
  return {e.begin() + kRunIn, e.end()};
}

TEST(Autoregression, OfOrderTwoHasTheTextbookCoefficients) {
  // π_1 = φ_1 / (1 - φ_2), π_2 = φ_2 (Box & Jenkins, section 3.2).
  const Autoregression noise({0.5 / 1.3, -0.3});
  EXPECT_THAT(std::vector<double>(noise.predictor(2).begin(), noise.predictor(2).end()),
              Pointwise(DoubleNear(1e-15), std::vector{0.5, -0.3}));
  EXPECT_DOUBLE_EQ(noise.predictor(1)[0], 0.5 / 1.3);
  EXPECT_TRUE(noise.predictor(0).empty());
  EXPECT_EQ(noise.relative_variance(2), 1.0);
}

TEST(Autoregression, RefusesWhatIsNotStationary) {
  for (const double partial : {1.0, -1.0, 1.5, std::nan("")})
    EXPECT_THROW(Autoregression({0.2, partial}), UsageError);
}

TEST(Autoregression, AutocorrelationSatisfiesYuleWalker) {
  for (const auto& partial : kPartials) {
    const Autoregression noise(partial);
    const std::vector<double> rho = noise.autocorrelation(30);
    EXPECT_EQ(rho[0], 1.0);
    double innovation = 1.0;  // of Var(e): 1 - Σ φ_j ρ_j
    for (int j = 1; j <= noise.order(); ++j)
      innovation -= noise.predictor(noise.order())[j - 1] * rho[j];
    // 1 - Σ φ ρ cancels to 1e-4 in the last of the cases.
    EXPECT_NEAR(innovation * noise.variance_ratio(), 1.0, 1e-11);
    for (int lag = 1; lag <= 30; ++lag) {
      double sum = 0.0;
      for (int j = 1; j <= noise.order(); ++j)
        sum += noise.predictor(noise.order())[j - 1] * rho[std::abs(lag - j)];
      EXPECT_NEAR(rho[lag], sum, 1e-13) << "order " << noise.order() << " lag " << lag;
    }
  }
}

TEST(Autoregression, WhiteningMakesTheExactCovarianceTheIdentity) {
  constexpr int kSamples = 40;
  for (const auto& partial : kPartials) {
    const Autoregression noise(partial);
    const Eigen::MatrixXd exact = covariance(noise, kSamples);
    Eigen::MatrixXd half = exact;
    noise.whiten(half);
    Eigen::MatrixXd both = half.transpose();
    noise.whiten(both);
    // 1e-12 of the identity, or rounding of the covariance where that is larger.
    const double size = std::max(1.0, exact.cwiseAbs().maxCoeff());
    EXPECT_LT((both - Eigen::MatrixXd::Identity(kSamples, kSamples)).cwiseAbs().maxCoeff(),
              1e-12 * size)
        << "order " << noise.order();
  }
}

TEST(Autoregression, LogDeterminantIsThatOfTheDenseCholeskyFactor) {
  for (const auto& partial : kPartials)
    for (const int n : {1, 2, 3, 5, 40}) {
      const Autoregression noise(partial);
      const Eigen::MatrixXd factor = covariance(noise, n).llt().matrixL();
      // The factor's own rounding, the larger the more nearly singular.
      EXPECT_NEAR(noise.log_determinant(n), 2.0 * factor.diagonal().array().log().sum(), 1e-9)
          << "order " << noise.order() << " n " << n;
    }
}

TEST(Autoregression, WhiteningUndoesTheRecursionAndFewRowsAreEnough) {
  const Autoregression noise({0.5 / 1.3, -0.3});
  const std::vector<double> innovations = white_noise(1000 + 500, "second order");
  const std::vector<double> e = second_order(1000, 0.5, -0.3);
  Eigen::MatrixXd rows = Eigen::Map<const Eigen::VectorXd>(e.data(), 1000);
  noise.whiten(rows);
  for (int t = 2; t < 1000; ++t) EXPECT_NEAR(rows(t, 0), innovations[t + 500], 1e-13);
  Eigen::MatrixXd one = Eigen::MatrixXd::Constant(1, 2, 3.0);
  noise.whiten(one);
  EXPECT_NEAR(one(0, 1), 3.0 / std::sqrt(noise.variance_ratio()), 1e-15);
}

TEST(Autoregression, LongRunRatioOfOrderOneIsKnown) {
  for (const double phi : {-0.5, 0.0, 0.3, 0.9})
    EXPECT_NEAR(Autoregression({phi}).long_run_ratio(), (1.0 + phi) / (1.0 - phi), 1e-13);
}

TEST(Autoregression, LongRunRatioIsTheSumOfTheAutocorrelation) {
  for (const auto& partial : kPartials) {
    const Autoregression noise(partial);
    double sum = -1.0;
    for (const double rho : noise.autocorrelation(20'000)) sum += 2.0 * rho;
    EXPECT_NEAR(sum, noise.long_run_ratio(), 1e-9 * std::max(1.0, sum));  // a sum of 40,000 terms
  }
}

TEST(Burg, RecoversASecondOrderSeries) {
  constexpr std::size_t kSamples = 40'000;
  const Autoregression found(Autoregression::burg(second_order(kSamples, 0.5, -0.3), 2));
  // Standard deviation of both estimates: sqrt((1 - φ_2^2) / N) = 0.0048 (Box & Jenkins, appendix
  // A7.4); four of them are a false alarm in 16,000.
  EXPECT_NEAR(found.predictor(2)[0], 0.5, 0.019);
  EXPECT_NEAR(found.predictor(2)[1], -0.3, 0.019);
}

TEST(Burg, OfASineIsItsTwoTermRecursion) {
  std::vector<double> sine(2000);
  for (std::size_t t = 0; t < sine.size(); ++t) sine[t] = std::sin(0.7 * static_cast<double>(t));
  // e_t = 2 cos(w) e_(t-1) - e_(t-2): π_1 = cos w up to the ends (1/N), π_2 = -1, clipped.
  const std::vector<double> partial = Autoregression::burg(sine, 2);
  EXPECT_NEAR(partial[0], std::cos(0.7), 1e-3);
  EXPECT_EQ(partial[1], -0.995);
}

TEST(Burg, OfZerosOrOfTooShortASeriesIsWhite) {
  EXPECT_THAT(Autoregression::burg(std::vector<double>(20, 0.0), 3), Each(0.0));
  EXPECT_EQ(Autoregression::burg(std::vector{1.0, 0.4}, 4).size(), 4u);
  EXPECT_EQ(Autoregression::burg(std::vector{1.0, 0.4}, 4)[1], 0.0);
  EXPECT_TRUE(Autoregression::burg({}, 0).empty());
}

// The first 20 yields of Box & Jenkins' series F. p by scipy 1.10: with r_k by numpy (mean removed,
// biased) and Q = n (n + 2) Σ r_k^2 / (n - k) = 11.944861697264768 over 5 lags,
// scipy.stats.chi2.sf(Q, dof) for 5, 3 and 1 degrees of freedom.
TEST(LjungBox, AgreesWithScipy) {
  const std::vector<double> yields{47, 64, 23, 71, 38, 64, 55, 41, 59, 48,
                                   71, 35, 57, 40, 58, 44, 80, 55, 37, 74};
  EXPECT_NEAR(ljung_box_p_value(yields, 5, 0), 0.03555116359211714, 1e-14);
  EXPECT_NEAR(ljung_box_p_value(yields, 5, 2), 0.007574447596004858, 1e-14);
  EXPECT_NEAR(ljung_box_p_value(yields, 5, 9), 0.0005479829859076362, 1e-15);
}

TEST(LjungBox, FindsWhiteNoiseWhiteAndCorrelatedNoiseNot) {
  // p is uniform for white noise: below 1e-3 once in a thousand seeds.
  EXPECT_GT(ljung_box_p_value(white_noise(2000, "white"), 20, 0), 1e-3);
  EXPECT_LT(ljung_box_p_value(second_order(2000, 0.5, -0.3), 20, 0), 1e-10);
  EXPECT_EQ(ljung_box_p_value(std::vector<double>(30, 0.1), 5, 0), 1.0);
}

}  // namespace
}  // namespace slideway
