#include "slideway/signal/lagged_products.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "signal/noise.hpp"

namespace slideway::lagged_products_test {
namespace {

// Sums of n products of normal numbers reach n, and each step may be off by half a last digit.
double rounding(std::ptrdiff_t n) { return 2.2e-16 * std::pow(static_cast<double>(n), 1.5); }

TEST(LaggedProducts, AreTheSumsOverAllPairsThatAreThere) {
  for (const std::ptrdiff_t n : {1, 5, 12, 100, 4096, 9001}) {
    const std::vector<double> x = white_noise(n, "x"), y = white_noise(n, "y");
    for (const std::ptrdiff_t first : {-200, -3, 0, 2}) {
      const std::vector<double> found = lagged_products(x, y, first, 211);
      ASSERT_EQ(found.size(), 211U);
      for (std::ptrdiff_t l = 0; l < 211; ++l) {
        double sum = 0.0;
        for (std::ptrdiff_t t = 0; t < n; ++t)
          if (t + first + l >= 0 && t + first + l < n) sum += x[t] * y[t + first + l];
        EXPECT_NEAR(found[l], sum, rounding(n)) << n << " samples, lag " << first + l;
      }
    }
  }
}

TEST(LaggedGrams, AreTheProductsOfTheRowsWithThoseBefore) {
  for (const Eigen::Index columns : {1, 4, 9})
    for (const Eigen::Index n : {6, 7, 300, 40'000}) {
      const std::vector<double> noise = white_noise(n * columns, "rows");
      const Eigen::Map<const Eigen::MatrixXd> rows(noise.data(), n, columns);
      const std::vector<Eigen::MatrixXd> found =
          lagged_grams({rows.leftCols(columns / 3), rows.rightCols(columns - columns / 3)}, 6);
      ASSERT_EQ(found.size(), 7U);
      for (Eigen::Index lag = 0; lag <= 6; ++lag) {
        const Eigen::MatrixXd expected =
            rows.bottomRows(n - 6).transpose() * rows.middleRows(6 - lag, n - 6);
        EXPECT_LE((found[lag] - expected).cwiseAbs().maxCoeff(), rounding(n)) << n << ' ' << lag;
      }
    }
}

}  // namespace
}  // namespace slideway::lagged_products_test
