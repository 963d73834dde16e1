#include "exchange.hpp"

#include <gmock/gmock.h>

#include <map>

namespace slideway::exchange_test {
namespace {

using ::testing::ElementsAre;

// The best cut alone is in no best pair: from {0, 1} an exchange leads to {1, 2}.
TEST(GreedySets, ExchangeACutThatWasBestAlone) {
  const std::map<CutSet, double> worth{{{0}, 3.0},    {{1}, 2.0},    {{2}, 1.0},      {{0, 1}, 4.0},
                                       {{0, 2}, 3.5}, {{1, 2}, 9.0}, {{0, 1, 2}, 9.5}};
  EXPECT_THAT(greedy_sets(3, 3, [&](const CutSet& set) { return worth.at(set); }),
              ElementsAre(CutSet{0}, CutSet{1, 2}, CutSet{0, 1, 2}));
}

// Where worths add up, the best set of n has the n best cuts.
TEST(GreedySets, AreTheBestCutsWhereWorthsAddUp) {
  const std::vector<double> each{2.0, 7.0, 1.0, 5.0, 3.0};
  const auto sum = [&](const CutSet& set) {
    double out = -20.0;
    for (const std::size_t cut : set) out += each[cut];
    return out;
  };
  EXPECT_THAT(greedy_sets(5, 4, sum),
              ElementsAre(CutSet{1}, CutSet{1, 3}, CutSet{1, 3, 4}, CutSet{0, 1, 3, 4}));
}

}  // namespace
}  // namespace slideway::exchange_test
