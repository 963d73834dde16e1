#include "slideway/machine/lower_body_array.hpp"

#include <gmock/gmock.h>

#include "slideway/base/error.hpp"

namespace slideway::lower_body_array_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusal(const std::vector<int>& lower) {
  try {
    LowerBodyArray array(lower);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LowerBodyArray, FollowsEquation1OnThePapersLathe) {
  const LowerBodyArray array(std::vector{0, 1});
  EXPECT_EQ(array(2, 0), 2);  // L^0(j) = j
  EXPECT_EQ(array(2, 1), 1);
  EXPECT_EQ(array(2, 2), 0);
  EXPECT_EQ(array(0, 5), 0);  // L^n(0) = 0
  EXPECT_EQ(array(2, 99), 0);
}

TEST(LowerBodyArray, IsTheIteratedOperatorOnABranchedTree) {
  // Bodies 1..6; the textbook rule L^n(j) = L(L^(n-1)(j)) must hold everywhere.
  const LowerBodyArray array(std::vector{0, 1, 1, 3, 0, 5});
  for (int j = 0; j <= array.size(); ++j)
    for (int n = 1; n < 8; ++n) EXPECT_EQ(array(j, n), array(array(j, n - 1))) << j << " " << n;
}

TEST(LowerBodyArray, PathRunsFromTheBedUpToTheBody) {
  const LowerBodyArray array(std::vector{3, 1, 0, 1});  // lower bodies may have larger numbers
  EXPECT_THAT(array.path(2), ElementsAre(3, 1, 2));
  EXPECT_THAT(array.path(3), ElementsAre(3));
  EXPECT_TRUE(array.path(0).empty());
}

TEST(LowerBodyArray, RefusesCyclesNamingTheirBodies) {
  EXPECT_THAT(refusal({0, 3, 2}), HasSubstr("body 3 on body 2 on body 3"));
  EXPECT_THAT(refusal({1}), HasSubstr("body 1 on body 1"));
  // A branch that leads into a cycle is not itself named as a part of it.
  EXPECT_THAT(refusal({2, 3, 2}), ::testing::Not(HasSubstr("body 1")));
}

TEST(LowerBodyArray, RefusesLowerBodiesThatAreNotThere) {
  EXPECT_THAT(refusal({0, 3}), HasSubstr("lower = 3; accepted: 0 (the bed) to 2"));
  EXPECT_THAT(refusal({-1}), HasSubstr("lower = -1"));
}

}  // namespace
}  // namespace slideway::lower_body_array_test
