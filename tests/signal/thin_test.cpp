#include "slideway/signal/thin.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace slideway::thin_test {
namespace {

using testing::Contains;

TEST(Thinned, KeepsEverythingOfAShortSeries) {
  const std::vector<double> series{3, 1, 2};
  EXPECT_EQ(thinned({series}, 4), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(Thinned, KeepsTheExtremesOfEverySeriesAndBothEnds) {
  std::vector<double> a(10000), b(10000);
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = std::sin(0.01 * static_cast<double>(i));
    b[i] = std::cos(0.37 * static_cast<double>(i));
  }
  a[1234] = 9.0;
  b[4321] = -9.0;
  const std::vector<std::size_t> kept = thinned({a, b}, 500);
  EXPECT_LE(kept.size(), 500U);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(kept.front(), 0U);
  EXPECT_EQ(kept.back(), 9999U);
  EXPECT_THAT(kept, Contains(1234U));
  EXPECT_THAT(kept, Contains(4321U));
}

TEST(Envelope, HoldsTheSeries) {
  const std::vector<double> series{1, 5, 2, -3, 4, 4, 0};
  const Envelope found = envelope(series, 2);
  EXPECT_EQ(found.low, (std::vector<double>{1, -3}));
  EXPECT_EQ(found.high, (std::vector<double>{5, 4}));
}

}  // namespace
}  // namespace slideway::thin_test
