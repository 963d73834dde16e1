#include "trend.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slideway {
namespace {

/// Values of one parameter, an item each, at times 0, 1, ...
std::vector<Trend> trends_of(const std::vector<double>& values, const std::vector<double>& u) {
  std::vector<std::vector<FittedParameter>> items;
  std::vector<double> times;
  for (std::size_t i = 0; i < values.size(); ++i) {
    FittedParameter parameter;
    parameter.value = values[i];
    parameter.standard_uncertainty = u[i];
    items.push_back({parameter});
    times.push_back(static_cast<double>(i));
  }
  return trends(items, times);
}

/// Weighted line at times 0, 1, ... in closed form.
struct Line {
  double slope = 0.0, variance = 0.0, chi_square = 0.0;
  double lost = 0.0;  // trace of the hat matrix, weighted

  Line(const std::vector<double>& y, const std::vector<double>& w) {
    double s = 0.0, sx = 0.0, sy = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i)
      s += w[i], sx += w[i] * static_cast<double>(i), sy += w[i] * y[i];
    double sxx = 0.0, sxy = 0.0;
    const auto about = [&](std::size_t i) { return static_cast<double>(i) - sx / s; };
    for (std::size_t i = 0; i < y.size(); ++i)
      sxx += w[i] * about(i) * about(i), sxy += w[i] * about(i) * y[i];
    slope = sxy / sxx;
    variance = 1.0 / sxx;
    for (std::size_t i = 0; i < y.size(); ++i) {
      chi_square += w[i] * std::pow(y[i] - sy / s - slope * about(i), 2);
      lost += w[i] * w[i] * (1.0 / s + about(i) * about(i) / sxx);
    }
  }
};

TEST(Trend, NeedsThreeItemsAtTwoTimes) {
  EXPECT_TRUE(trends_of({1.0, 2.0}, {1.0, 1.0}).empty());
  EXPECT_EQ(trends_of({1.0, 2.0, 4.0}, {1.0, 1.0, 1.0}).size(), 1U);
}

// Ordinary least squares: what equal uncertainties leave is between the items. Student's t of two
// degrees of freedom: P(|T| > t) = 1 - t / √(2 + t²), and k = 4.53 (GUM, table G.2).
TEST(Trend, IsTheRegressionLine) {
  const std::vector<double> y{1.0, 3.5, 4.5, 9.0}, one(4, 1.0), u(4, 0.1);
  const Line line(y, one);
  const std::vector<Trend> found = trends_of(y, u);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].rate, line.slope, 1e-12);
  const double of_rate = std::sqrt(line.chi_square / 2.0 * line.variance);
  EXPECT_NEAR(found[0].standard_uncertainty, of_rate, 1e-12);
  EXPECT_NEAR(found[0].between_items, std::sqrt(line.chi_square / 2.0 - 0.01), 1e-12);
  EXPECT_NEAR(found[0].expanded_uncertainty / of_rate, 4.53, 0.005);
  const double t = line.slope / of_rate;
  EXPECT_NEAR(found[0].p_value, 1.0 - t / std::sqrt(2.0 + t * t), 1e-9);
}

TEST(Trend, KeepsTheUncertaintyOfItemsThatAgreeBetter) {
  const std::vector<double> y{0.0, 1.0, 2.0, 3.0, 4.0}, u(5, 0.5);
  const std::vector<Trend> found = trends_of(y, u);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].rate, 1.0, 1e-12);
  EXPECT_NEAR(found[0].standard_uncertainty, 0.5 / std::sqrt(10.0), 1e-12);  // Σ (i - 2)² = 10
  EXPECT_EQ(found[0].between_items, 0.0);
}

// DerSimonian and Laird (1986) for a line, and what unequal uncertainties leave beyond it (Knapp
// and Hartung 2003): τ² = (Q - (n - 2)) / (Σw - tr).
TEST(Trend, AllowsForWhatUnequalUncertaintiesLeave) {
  const std::vector<double> y{0.0, 0.0, 0.0, 9.0, 0.0}, u{0.1, 0.1, 0.1, 1.0, 0.1};
  std::vector<double> w, with_between;
  double sum = 0.0;
  for (const double each : u) w.push_back(1.0 / (each * each)), sum += w.back();
  const Line first(y, w);
  const double between = (first.chi_square - 3.0) / (sum - first.lost);
  for (const double each : u) with_between.push_back(1.0 / (each * each + between));
  const Line line(y, with_between);
  ASSERT_GT(line.chi_square, 3.0);
  const std::vector<Trend> found = trends_of(y, u);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].rate, line.slope, 1e-9);
  EXPECT_NEAR(found[0].between_items, std::sqrt(between), 1e-9);
  EXPECT_NEAR(found[0].standard_uncertainty, std::sqrt(line.variance * line.chi_square / 3.0),
              1e-9);
}

}  // namespace
}  // namespace slideway
