#include "slideway/base/minimum.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace slideway {
namespace {

// cosh(x - 0.3) is least at 0.3; (x - 2)^4 is flat there, and a bound is met where it falls to it.
TEST(Minimum, IsPlacedToAThousandthOfTheRange) {
  EXPECT_NEAR(place_of_minimum([](double x) { return std::cosh(x - 0.3); }, -1.0, 1.0), 0.3, 2e-3);
  EXPECT_NEAR(place_of_minimum([](double x) { return std::pow(x - 2.0, 4); }, 0.0, 5.0), 2.0, 5e-3);
  EXPECT_NEAR(place_of_minimum([](double x) { return -x; }, 0.0, 10.0), 10.0, 1e-2);
}

}  // namespace
}  // namespace slideway
