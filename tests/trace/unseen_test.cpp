// Which effects a value holds beside itself, as its columns are theirs too.

#include "slideway/trace/unseen.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <optional>

#include "slideway/effects/catalogue.hpp"

namespace slideway::unseen_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Result sample() {
  Result result;
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

slideway::Setup reading(Kind kind, Quantity quantity = Quantity::slope,
                        std::optional<CutDirection> direction = std::nullopt) {
  slideway::Setup out;
  out.kind = kind;
  out.quantity = quantity;
  out.cut_direction = direction;
  return out;
}

slideway::Setup timed(std::vector<double> times_s) {
  slideway::Setup out = reading(Kind::slide);
  out.reading_times =
      std::make_shared<const ReadingTimes>(ReadingTimes{{0.0, 50.0, 100.0}, std::move(times_s)});
  return out;
}

slideway::Setup reversed(slideway::Setup setup) {
  setup.reversed = true;
  return setup;
}

/// The result of a model that is fitted to such readings.
Result with_conditions(const std::vector<slideway::Setup>& readings, Result result = sample(),
                       const std::vector<DeclaredEffect>& more = {}) {
  Problem problem;
  problem.bodies = Machine::paper_lathe();
  problem.low_band.level = 0;
  problem.effects = {{"straightness", {.degree = 2}, {}}};
  problem.effects.insert(problem.effects.end(), more.begin(), more.end());
  std::vector<Profile> profiles;
  for (const slideway::Setup& setup : readings) {
    Profile& profile = profiles.emplace_back();
    profile.name = "r" + std::to_string(profiles.size());
    profile.setup = setup;
    profile.positions = {0.0, 50.0, 100.0};
    profile.values = {0.0, 0.0, 0.0};
  }
  add_conditions(build_model(problem, profiles), single_cut(), result);
  return result;
}

std::vector<std::string> of_straightness(const std::vector<slideway::Setup>& readings) {
  return with_conditions(readings).final->straightness->if_no;
}

TEST(Conditions, AreTheEffectsThatHaveTheColumnsOfAValue) {
  const Result result = with_conditions({reading(Kind::face, Quantity::height)});
  EXPECT_THAT(result.final->parameters[0].if_no, ElementsAre("cup", "linear_drift"));
  EXPECT_THAT(result.final->parameters[1].if_no, IsEmpty());
  EXPECT_THAT(result.final->straightness->if_no, ElementsAre("cup"));
  EXPECT_THAT(result.conformity[0].if_no, IsEmpty());  // of the readings, whatever made them
  EXPECT_THAT(result.conformity[1].if_no, ElementsAre("cup"));
  EXPECT_THAT(result.conformity[2].if_no, ElementsAre("cup", "linear_drift"));
}

TEST(Conditions, AreNoneWhereNothingWasDeterminedOrNoFaceWasRead) {
  Result result = sample();
  result.final->parameters[0].value.reset();
  result.final->straightness->errors.clear();
  result = with_conditions({reading(Kind::face, Quantity::height)}, result);
  EXPECT_THAT(result.final->parameters[0].if_no, IsEmpty());
  EXPECT_THAT(result.final->straightness->if_no, IsEmpty());
  result = with_conditions({reading(Kind::slide, Quantity::height)});
  EXPECT_THAT(result.final->straightness->if_no, IsEmpty());
  EXPECT_THAT(result.final->parameters[0].if_no, IsEmpty());
  EXPECT_THAT(result.conformity[2].if_no, IsEmpty());
}

// b_2 makes slopes that are a line over x, a zero that drifts at an even pace a line over the time.
TEST(Conditions, OfSlopesReadOneWayAreADriftOfTheZero) {
  const slideway::Setup unknown = reading(Kind::slide), there = timed({0.0, 20.0, 40.0}),
                        back = timed({99.0, 80.0, 60.0}), restless = timed({0.0, 90.0, 40.0}),
                        inward = reading(Kind::slide, Quantity::slope, CutDirection::inward);
  for (const auto& one_way : std::vector<std::vector<slideway::Setup>>{
           {unknown}, {unknown, unknown}, {there, unknown}, {back}, {there, reversed(back)}})
    EXPECT_THAT(of_straightness(one_way), ElementsAre("zero_drift"));
  for (const auto& both_ways : std::vector<std::vector<slideway::Setup>>{
           {there, back}, {unknown, inward}, {unknown, reversed(unknown)}, {back, restless}})
    EXPECT_THAT(of_straightness(both_ways), IsEmpty());
  const Result result = with_conditions({there});
  EXPECT_THAT(result.conformity[0].if_no, IsEmpty());
  EXPECT_THAT(result.conformity[1].if_no, ElementsAre("zero_drift"));
  EXPECT_THAT(
      with_conditions({there}, sample(), {{"zero_drift", {}, {}}}).final->straightness->if_no,
      IsEmpty());
}

}  // namespace
}  // namespace slideway::unseen_test
