// Which effects a value holds beside itself, as its columns are theirs too.

#include "slideway/trace/unseen.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <optional>

#include "slideway/base/random.hpp"
#include "slideway/identify/identify.hpp"

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
      std::make_shared<const ReadingTimes>(ReadingTimes{{-50.0, 0.0, 50.0}, std::move(times_s)});
  return out;
}

slideway::Setup reversed(slideway::Setup setup) {
  setup.reversed = true;
  return setup;
}

/// The result of a model that is fitted to such readings.
Result with_conditions(const std::vector<slideway::Setup>& readings, Result result = sample(),
                       const std::vector<DeclaredEffect>& more = {}, int degree = 2,
                       double noise_of_slide = 1e-6, const TraceResult& trace = single_cut(),
                       const std::vector<Body>& bodies = Machine::paper_lathe()) {
  Problem problem;
  problem.bodies = bodies;
  problem.low_band.level = 0;
  problem.effects = {{"straightness", {.body = "x_carriage", .degree = degree}, {}}};
  problem.effects.insert(problem.effects.end(), more.begin(), more.end());
  std::vector<Profile> profiles;
  for (const slideway::Setup& setup : readings) {
    Profile& profile = profiles.emplace_back();
    profile.name = "r" + std::to_string(profiles.size());
    profile.setup = setup;
    if (setup.kind == Kind::face) profile.setup.cut_radius_mm = 50.0;
    RandomStream noise(1, profile.name);
    for (int i = 0; i <= 100; ++i) {
      profile.positions.push_back(i - 50);
      profile.values.push_back((setup.kind == Kind::slide ? noise_of_slide : 1e-6) *
                               noise.normal());
    }
  }
  add_conditions(fit_declared(problem, profiles), trace, result);
  return result;
}

std::vector<std::string> of_straightness(const std::vector<slideway::Setup>& readings) {
  return with_conditions(readings).final->straightness->if_no;
}

TEST(Conditions, AreTheEffectsThatHaveTheColumnsOfAValue) {
  const Result result =
      with_conditions({reading(Kind::face, Quantity::height)}, sample(), {{"squareness", {}, {}}});
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

// (1 - k) b_k r^k up to k = 5 make most of a cone, -Δβxz r: a declared squareness says so by U.
TEST(Conditions, OfAFormWithoutSquarenessAreTheSquarenessThatItHides) {
  const std::vector<slideway::Setup> face{reading(Kind::face, Quantity::height)};
  EXPECT_THAT(with_conditions(face, sample(), {}, 5).final->straightness->if_no,
              ElementsAre("cup", "squareness"));
  EXPECT_THAT(
      with_conditions(face, sample(), {{"squareness", {}, {}}}, 5).final->straightness->if_no,
      ElementsAre("cup"));
}

// Two carriages move along X, and nobody said whose squareness it would be.
TEST(Conditions, AskForNoCarriageThatIsOpen) {
  const std::vector<Body> bodies{
      {"z_carriage", 0, Axis::z}, {"x_carriage", 1, Axis::x}, {"top_slide", 2, Axis::x}};
  const Result result = with_conditions({reading(Kind::face, Quantity::height)}, sample(), {}, 5,
                                        1e-6, single_cut(), bodies);
  EXPECT_THAT(result.final->straightness->if_no, ElementsAre("cup"));
}

// On the lever r the cup is b_2 of a face. A reading of the slide tells them apart: one with the
// noise of the faces, one with ten thousand times as much does not. Both rest on the straightedge.
TEST(Conditions, OfFacesBesideASlideAreTheWorkpieceIfTheReadingIsPoorAndTheStraightedge) {
  const slideway::Setup face = reading(Kind::face, Quantity::height),
                        slide = reading(Kind::slide, Quantity::height);
  TraceResult trace;
  const auto of_slide_with = [&](double noise_mm) {
    return with_conditions({face, slide}, sample(), {{"squareness", {}, {}}}, 2, noise_mm, trace)
        .final->straightness->if_no;
  };
  EXPECT_THAT(of_slide_with(1e-6), ElementsAre("artefact_form"));
  EXPECT_THAT(of_slide_with(1e-2), ElementsAre("cup", "artefact_form"));
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
