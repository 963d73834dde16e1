#include <gtest/gtest.h>

#include "signal/noise.hpp"
#include "slideway/signal/correlation.hpp"

namespace slideway::ljung_box_test {
namespace {

std::vector<double> second_order(std::size_t n, double phi1, double phi2) {
  constexpr std::size_t kRunIn = 500;
  std::vector<double> e = white_noise(n + kRunIn, "second order");
  for (std::size_t t = 2; t < e.size(); ++t) e[t] += phi1 * e[t - 1] + phi2 * e[t - 2];
  return {e.begin() + kRunIn, e.end()};
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
}  // namespace slideway::ljung_box_test
