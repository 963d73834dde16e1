#include "slideway/base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace slideway {
namespace {

// Statistics are compared at five standard deviations of their sampling distribution
// (asymptotically normal): false-alarm rate 6e-7 each. The seeds are fixed, so a pass stays a pass.
constexpr int kCount = 1000000;
constexpr double kFive = 5.0;

std::vector<double> normals(std::uint64_t seed, const std::string& name, int count) {
  RandomStream stream(seed, name);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(stream.normal());
  return values;
}

TEST(RandomStream, RepeatsItselfForTheSameSeedAndName) {
  EXPECT_EQ(normals(7, "feed2", 1000), normals(7, "feed2", 1000));
}

TEST(RandomStream, UniformFillsTheUnitIntervalEvenly) {
  RandomStream stream(1, "uniform");
  std::array<int, 100> bins{};
  for (int i = 0; i < kCount; ++i) {
    const double value = stream.uniform();
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    ASSERT_EQ(std::trunc(value * 0x1p53), value * 0x1p53);
    ++bins[static_cast<std::size_t>(value * 100.0)];
  }
  double chi_square = 0.0;
  for (const int bin : bins) chi_square += (bin - 1e4) * (bin - 1e4) / 1e4;
  EXPECT_NEAR(chi_square, 99.0, kFive * std::sqrt(2.0 * 99.0));
}

TEST(RandomStream, NormalHasTheMomentsAndTailsOfTheStandardNormal) {
  std::array<double, 5> moment{};
  double beyond_three = 0.0;
  for (const double value : normals(2, "normal", kCount)) {
    for (int p = 1; p <= 4; ++p) moment[p] += std::pow(value, p) / kCount;
    if (std::abs(value) > 3.0) beyond_three += 1.0 / kCount;
  }
  // E z^p = 0, 1, 0, 3 and E z^2p = 1, 3, 15, 105.
  EXPECT_NEAR(moment[1], 0.0, kFive * std::sqrt(1.0 / kCount));
  EXPECT_NEAR(moment[2], 1.0, kFive * std::sqrt((3.0 - 1.0) / kCount));
  EXPECT_NEAR(moment[3], 0.0, kFive * std::sqrt(15.0 / kCount));
  EXPECT_NEAR(moment[4], 3.0, kFive * std::sqrt((105.0 - 9.0) / kCount));
  const double tail = std::erfc(3.0 / std::sqrt(2.0));
  EXPECT_NEAR(beyond_three, tail, kFive * std::sqrt(tail * (1.0 - tail) / kCount));
}

TEST(RandomStream, StreamsOfOtherSeedsAndNamesAreUncorrelated) {
  const std::vector<double> base = normals(1, "a", kCount / 10);
  const double limit = kFive / std::sqrt(static_cast<double>(base.size()));
  for (const auto& other : {normals(2, "a", kCount / 10), normals(1, "b", kCount / 10),
                            normals(0, "a", kCount / 10), normals(1, "", kCount / 10)}) {
    for (const std::size_t lag : {0, 1, 2}) {
      double correlation = 0.0;
      for (std::size_t i = lag; i < base.size(); ++i)
        correlation += base[i] * other[i - lag] / static_cast<double>(base.size());
      EXPECT_NEAR(correlation, 0.0, limit);
    }
  }
}

TEST(RandomStream, SuccessiveNormalsAreUncorrelated) {
  const std::vector<double> values = normals(3, "normal", kCount);
  double correlation = 0.0;
  for (std::size_t i = 1; i < values.size(); ++i) correlation += values[i] * values[i - 1] / kCount;
  EXPECT_NEAR(correlation, 0.0, kFive / std::sqrt(static_cast<double>(kCount)));
}

}  // namespace
}  // namespace slideway
