// Shapes in no catalogue are described, and the least bad name is not given.

#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

TraceResult close_on(const std::string& shape) {
  RandomStream random(11, shape);
  const turning::Hidden hidden = turning::make_hidden(shape, 0.2e-3, random);
  return close_loop(problem_of(), quarter_faces(hidden, 2, kBlunt, 11));
}

TEST(Unnamed, TwoBumpsLiveOnTheRadius) {
  const TraceResult result = close_on("double_bump");
  SCOPED_TRACE(story(result));
  EXPECT_EQ(result.verdict, "unnamed");
  EXPECT_TRUE(is_negative(result));
  EXPECT_THAT(named(result), ::testing::IsEmpty());
  ASSERT_TRUE(result.unnamed);
  EXPECT_EQ(result.unnamed->clock, "r");
  EXPECT_LT(result.unnamed->p_value, 1e-3);
  // Both halves of the diameter show it alike.
  ASSERT_TRUE(result.unnamed->odd_share);
  EXPECT_LT(*result.unnamed->odd_share, 0.05);
}

TEST(Unnamed, ChirpIsNoLine) {
  const TraceResult result = close_on("chirp");
  SCOPED_TRACE(story(result));
  EXPECT_EQ(result.verdict, "unnamed");
  EXPECT_THAT(named(result), ::testing::IsEmpty());
  ASSERT_TRUE(result.unnamed);
}

}  // namespace
}  // namespace slideway
