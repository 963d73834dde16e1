#include "slideway/base/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace slideway {
namespace {

// 0, 1, ... n - 1: mean (n - 1) / 2, variance (n² - 1) / 12.
TEST(Statistics, OfTheFirstIntegersAreThoseOfTheTextbook) {
  for (const std::size_t n : {1u, 2u, 5u, 32'768u, 32'769u, 200'003u}) {
    std::vector<double> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<double>(i * 7919 % n);
    const Statistics found = statistics_of(values);
    const auto count = static_cast<double>(n);
    const double deviation = std::sqrt((count * count - 1.0) / 12.0);
    EXPECT_NEAR(found.mean, (count - 1.0) / 2.0, 1e-13 * count);
    EXPECT_NEAR(found.deviation, deviation, 1e-13 * count);
    EXPECT_EQ(found.least, 0.0);
    EXPECT_EQ(found.largest, count - 1.0);
  }
}

// The spread of 4, 7, 13, 16 is sqrt(22.5), with 1e9 added too (Welford's trap; every step exact).
TEST(Statistics, KeepTheirDigitsBesideALargeMean) {
  const Statistics found = statistics_of(std::vector{1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16});
  EXPECT_EQ(found.mean, 1e9 + 10);
  EXPECT_DOUBLE_EQ(found.deviation, std::sqrt(22.5));
}

TEST(Median, IsTheUpperOfTheTwoInTheMiddle) {
  const auto of = [](std::vector<double> values) { return median(values); };
  EXPECT_EQ(of({3.0}), 3.0);
  EXPECT_EQ(of({9.0, -2.0, 4.0}), 4.0);
  EXPECT_EQ(of({7.0, 1.0, 5.0, 2.0}), 5.0);
}

}  // namespace
}  // namespace slideway
