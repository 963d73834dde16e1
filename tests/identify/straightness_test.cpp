#include "slideway/identify/straightness.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slideway {
namespace {

// y = x² on [0, 1]: the end-point and the minimum-zone line have slope 1 and a strip of 1/4
// (deviation x² - x, least at 1/2); the least-squares line is x - 1/6.
class Parabola : public testing::Test {
 protected:
  Parabola()
      : x_(Eigen::VectorXd::LinSpaced(1001, 0.0, 1.0)),
        lines_(reference_lines(x_, x_.array().square())) {}
  Eigen::VectorXd x_;
  std::vector<ReferenceLine> lines_;
};

TEST_F(Parabola, HasTheErrorsOfItsThreeLines) {
  ASSERT_EQ(lines_.size(), 3U);
  EXPECT_EQ(lines_[0].name, "end-point");
  EXPECT_NEAR(lines_[0].error, 0.25, 1e-12);
  EXPECT_NEAR(lines_[0].highest, 0.0, 1e-12);
  EXPECT_NEAR(lines_[0].lowest, -0.25, 1e-12);
  EXPECT_EQ(lines_[0].lowest_at, 500U);
  EXPECT_EQ(lines_[1].name, "least squares");
  EXPECT_NEAR(lines_[1].slope, 1.0, 1e-9);
  EXPECT_NEAR(lines_[1].at_zero, -1.0 / 6.0, 1e-3);  // of 1001 points, not of the integral
  EXPECT_EQ(lines_[2].name, "minimum zone");
  EXPECT_NEAR(lines_[2].error, 0.25, 1e-12);
  EXPECT_NEAR(lines_[2].highest, 0.125, 1e-12);
  EXPECT_NEAR(lines_[2].lowest, -0.125, 1e-12);
}

TEST_F(Parabola, SensitivityIsTheDerivativeOfTheError) {
  const Eigen::VectorXd z = x_.array().square();
  Eigen::VectorXd bent = z;
  for (Eigen::Index i = 0; i < bent.size(); ++i) bent[i] += 1e-7 * std::sin(7.0 * x_[i]);
  const std::vector<ReferenceLine> moved = reference_lines(x_, bent);
  for (std::size_t l = 0; l < lines_.size(); ++l)
    EXPECT_NEAR(lines_[l].sensitivity.dot(bent - z), moved[l].error - lines_[l].error, 1e-12)
        << lines_[l].name;
}

TEST(ReferenceLines, OfAStraightLineLeaveNothing) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(11, -5.0, 5.0);
  for (const ReferenceLine& line : reference_lines(x, 2.0 * x.array() + 1.0)) {
    EXPECT_NEAR(line.error, 0.0, 1e-12) << line.name;
    EXPECT_NEAR(line.slope, 2.0, 1e-12) << line.name;
  }
}

// No line has a narrower strip than the minimum zone's; ISO 230-1:2012, 3.4.
TEST(ReferenceLines, MinimumZoneIsTheNarrowest) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(101, 0.0, 10.0);
  const Eigen::VectorXd z =
      x.unaryExpr([](double v) { return std::sin(v) + 0.3 * std::cos(3.1 * v); });
  const std::vector<ReferenceLine> lines = reference_lines(x, z);
  EXPECT_LE(lines[2].error, lines[0].error);
  EXPECT_LE(lines[2].error, lines[1].error);
  for (double slope = -1.0; slope <= 1.0; slope += 1e-3) {
    const Eigen::VectorXd rest = z - slope * x;
    EXPECT_GE(rest.maxCoeff() - rest.minCoeff(), lines[2].error - 1e-12);
  }
}

}  // namespace
}  // namespace slideway
