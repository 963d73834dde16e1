#include "slideway/machine/transform.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

namespace slideway::transform_test {
namespace {

// Eq. (2) as printed, the four matrices one by one.
Transform printed(const ErrorMotion& m) {
  Transform a = Transform::Identity();
  a(1, 1) = a(2, 2) = std::cos(m.alpha);
  a(1, 2) = -(a(2, 1) = std::sin(m.alpha));
  Transform b = Transform::Identity();
  b(0, 0) = b(2, 2) = std::cos(m.beta);
  b(2, 0) = -(b(0, 2) = std::sin(m.beta));
  Transform c = Transform::Identity();
  c(0, 0) = c(1, 1) = std::cos(m.gamma);
  c(0, 1) = -(c(1, 0) = std::sin(m.gamma));
  Transform t = Transform::Identity();
  t(0, 3) = m.x;
  t(1, 3) = m.y;
  t(2, 3) = m.z;
  return a * b * c * t;
}

constexpr ErrorMotion kLarge{1.0, -2.0, 3.0, 0.4, -0.5, 0.6};

TEST(Transform, IsThePrintedProductOfEquation2) {
  // 4 products of numbers of order 1: a few units of the last place.
  EXPECT_LT((exact_transform(kLarge) - printed(kLarge)).norm(), 1e-14);
}

TEST(Transform, IsARigidMotion) {
  const Eigen::Matrix3d rotation = exact_transform(kLarge).topLeftCorner<3, 3>();
  EXPECT_LT((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 1e-15 * 10);
  EXPECT_NEAR(rotation.determinant(), 1.0, 1e-15 * 10);
}

TEST(Transform, FirstOrderIsTheMatrixOfEquation4) {
  Transform expected;
  expected << 1, -6, 5, 1, 6, 1, -4, 2, -5, 4, 1, 3, 0, 0, 0, 1;
  EXPECT_EQ(first_order_transform({1, 2, 3, 4, 5, 6}), expected);
}

TEST(Transform, FirstOrderDiffersFromExactBySecondOrder) {
  const auto difference = [](double scale) {
    const ErrorMotion small{scale, -2 * scale, 3 * scale, 0.4 * scale, -0.5 * scale, 0.6 * scale};
    return (exact_transform(small) - first_order_transform(small)).norm();
  };
  // Halving the errors quarters the difference; the third-order term is 1e-3 of it here.
  EXPECT_NEAR(difference(1e-3) / difference(5e-4), 4.0, 4e-2);
}

}  // namespace
}  // namespace slideway::transform_test
