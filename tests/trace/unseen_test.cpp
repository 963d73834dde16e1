// Which effects a value holds beside itself, as its columns are theirs too.

#include "slideway/trace/unseen.hpp"

#include <gmock/gmock.h>

namespace slideway::unseen_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Result of(Kind kind) {
  Result result;
  result.inputs.emplace_back().kind = kind;
  ModelResult& model = result.final.emplace();
  FittedParameter& angle = model.parameters.emplace_back();
  angle.name = "squareness.dbeta_xz";
  angle.value = 2.8e-6;
  model.parameters.emplace_back().name = "straightness.b2";
  model.straightness.emplace().errors.resize(1);
  result.conformity = {{.what = kFlatness, .limit_um = 1.0},
                       {.what = "straightness", .limit_um = 1.0},
                       {.what = "squareness", .limit_um_per_m = 1.0}};
  return result;
}

TraceResult single_cut() {
  TraceResult trace;
  trace.not_separable = {{"cup", "squareness.dbeta_xz, straightness.b2"},
                         {"linear_drift", "squareness.dbeta_xz"},
                         {"tool_wear", "vertical_straightness.c1"}};
  return trace;
}

TEST(Conditions, AreTheEffectsThatHaveTheColumnsOfAValue) {
  Result result = of(Kind::face);
  add_conditions(single_cut(), result);
  EXPECT_THAT(result.final->parameters[0].if_no, ElementsAre("cup", "linear_drift"));
  EXPECT_THAT(result.final->parameters[1].if_no, IsEmpty());
  EXPECT_THAT(result.final->straightness->if_no, ElementsAre("cup"));
  EXPECT_THAT(result.conformity[0].if_no, IsEmpty());  // of the readings, whatever made them
  EXPECT_THAT(result.conformity[1].if_no, ElementsAre("cup"));
  EXPECT_THAT(result.conformity[2].if_no, ElementsAre("cup", "linear_drift"));
}

TEST(Conditions, AreNoneWhereNothingWasDeterminedOrNoFaceWasRead) {
  Result result = of(Kind::face);
  result.final->parameters[0].value.reset();
  result.final->straightness->errors.clear();
  add_conditions(single_cut(), result);
  EXPECT_THAT(result.final->parameters[0].if_no, IsEmpty());
  EXPECT_THAT(result.final->straightness->if_no, IsEmpty());
  result = of(Kind::slide);
  add_conditions(single_cut(), result);
  EXPECT_THAT(result.final->parameters[0].if_no, IsEmpty());
  EXPECT_THAT(result.conformity[2].if_no, IsEmpty());
}

}  // namespace
}  // namespace slideway::unseen_test
