// Shapes in no catalogue are described, and the least bad name is not given.

#include "slideway/trace/analysis.hpp"
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
  EXPECT_EQ(result.verdict, TraceVerdict::unnamed);
  EXPECT_TRUE(is_negative(result));
  EXPECT_THAT(named(result), ::testing::IsEmpty());
  ASSERT_TRUE(result.unnamed);
  EXPECT_EQ(result.unnamed->clock, "r");
  EXPECT_LT(result.unnamed->p_value, 1e-3);
  // Both halves of the diameter show it alike.
  ASSERT_TRUE(result.unnamed->odd_share);
  EXPECT_LT(*result.unnamed->odd_share, 0.05);
  // Evidence is told in the report's unit.
  EXPECT_THAT(result.notes, ::testing::Contains(::testing::HasSubstr("difference in BIC")));
  EXPECT_THAT(result.notes, ::testing::Not(::testing::Contains(::testing::HasSubstr("nats"))));
}

// Of a straightness of degree 2 all that is not the reference line's is b_2's: curve and parameter
// are known alike.
TEST(Unnamed, WidensTheStraightnessWithItsParameter) {
  RandomStream random(11, "double_bump");
  const turning::Hidden hidden = turning::make_hidden("double_bump", 0.2e-3, random);
  Problem problem = problem_of({"thermal_drift"});
  problem.effects[1].options.degree = 2;
  const Analysis analysis =
      analyse(problem, quarter_faces(hidden, 2, kBlunt, 11), {.with_details = true});
  SCOPED_TRACE(story(*analysis.trace));
  ASSERT_EQ(analysis.trace->verdict, TraceVerdict::unnamed);
  const FittedParameter* b2 = find(analysis.result.final->parameters, "straightness.b2");
  ASSERT_NE(b2, nullptr);
  const double share = *b2->expanded_uncertainty / std::abs(*b2->value);
  const Straightness& found = *analysis.result.final->straightness;
  ASSERT_EQ(found.reason, "");
  const StraightnessCurve& curve = found.curve;
  // The curve beside it, which the bumps ask for, adds to that, or takes back a part.
  constexpr double kTakenBack = 0.1;
  for (std::size_t i = 0; i < curve.position_mm.size(); ++i)
    EXPECT_GE(curve.expanded_uncertainty_um[i],
              (1.0 - kTakenBack) * share * std::abs(curve.deviation_um[i]));
  for (const StraightnessError& error : found.errors)
    EXPECT_GE(*error.expanded_uncertainty / *error.value, (1.0 - kTakenBack) * share)
        << text_of(error.line);
}

TEST(Unnamed, ChirpIsNoLine) {
  const TraceResult result = close_on("chirp");
  SCOPED_TRACE(story(result));
  EXPECT_EQ(result.verdict, TraceVerdict::unnamed);
  EXPECT_THAT(named(result), ::testing::IsEmpty());
  ASSERT_TRUE(result.unnamed);
}

}  // namespace
}  // namespace slideway
