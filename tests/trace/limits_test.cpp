// What is held out, what cannot be tested, what may be searched.

#include <optional>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/effects/catalogue.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::HasSubstr;
using turning::ToolPoint;

const turning::Hidden& drift() {
  static const turning::Hidden kDrift{"linear_drift",
                                      [](const ToolPoint& p) { return 0.6e-3 * p.t / 300.0; }};
  return kDrift;
}

Problem small_problem() { return problem_of({"linear_drift", "slide_periodic", "centre_step"}); }

std::vector<std::optional<double>> values_of(const std::vector<FittedParameter>& parameters) {
  std::vector<std::optional<double>> out;
  for (const FittedParameter& p : parameters) out.push_back(p.value);
  return out;
}

TEST(HeldOut, ProfileIsPredictedAndNeverFitted) {
  std::vector<Profile> cuts = quarter_faces(drift(), 3, kBlunt, 5);
  cuts[2].role = Role::holdout;
  const Closed result = closed(small_problem(), cuts);
  SCOPED_TRACE(story(result));
  const TraceRound* round = round_of(result, "linear_drift");
  ASSERT_NE(round, nullptr);
  ASSERT_TRUE(round->before_holdout_rms_um && round->after_holdout_rms_um);
  EXPECT_LT(*round->after_holdout_rms_um, *round->before_holdout_rms_um);

  RandomStream random(1, "other noise");
  for (double& value : cuts[2].values) value += 0.005e-3 * random.normal();
  const Closed other = closed(small_problem(), cuts);
  EXPECT_EQ(values_of(other.declared.parameters), values_of(result.declared.parameters));
  EXPECT_EQ(values_of(other.final.parameters), values_of(result.final.parameters));
  const TraceRound* again = round_of(other, "linear_drift");
  ASSERT_NE(again, nullptr);
  EXPECT_EQ(again->delta_bic, round->delta_bic);
  EXPECT_EQ(again->before_rms_um, round->before_rms_um);
  EXPECT_EQ(again->after_rms_um, round->after_rms_um);
  EXPECT_NE(*again->after_holdout_rms_um, *round->after_holdout_rms_um);
}

TEST(HeldOut, EachProfileInTurnWhereNoneIs) {
  const Closed result = closed(small_problem(), quarter_faces(drift(), 3, kBlunt, 5));
  SCOPED_TRACE(story(result));
  const TraceRound* round = round_of(result, "linear_drift");
  ASSERT_NE(round, nullptr);
  ASSERT_TRUE(round->before_holdout_rms_um && round->after_holdout_rms_um);
  EXPECT_LT(*round->after_holdout_rms_um, *round->before_holdout_rms_um);
}

TEST(Testable, NeedsTheMetadataOfTheClock) {
  std::vector<Profile> cut = quarter_faces({"clean"}, 1, kBlunt, 1);
  cut[0].setup.feed_mm_per_min.reset();
  cut[0].setup.traverse_mm_per_s.reset();
  const Closed result =
      closed(problem_of({"thermal_drift", "tool_wear", "traverse_periodic", "centre_step"}), cut);
  EXPECT_THAT(result.not_testable,
              ::testing::UnorderedElementsAre(
                  ::testing::FieldsAre("thermal_drift", HasSubstr("feed_mm_per_min")),
                  ::testing::FieldsAre("tool_wear", HasSubstr("feed_mm_per_min")),
                  ::testing::FieldsAre("traverse_periodic", HasSubstr("traverse_mm_per_s"))));
}

TEST(Testable, NeedsAProfileThatShowsIt) {
  std::vector<Profile> cut = quarter_faces({"clean"}, 1, kBlunt, 1);
  cut.push_back(cut[0]);
  cut[0].role = Role::holdout;
  cut[1].name = "fitted";
  cut[1].setup.kind = Kind::slide;
  Problem problem = problem_of({"cup"});
  problem.effects = {{"straightness", {std::nullopt, 3, std::nullopt}, {}}};
  const Closed result = closed(problem, cut);
  EXPECT_THAT(result.not_testable,
              ::testing::ElementsAre(::testing::FieldsAre("cup", HasSubstr("reading"))));
}

TEST(Search, LooksOnlyAtItsCandidates) {
  const Closed result =
      closed(problem_of({"slide_periodic", "centre_step"}), quarter_faces(drift(), 2, kBlunt, 5));
  SCOPED_TRACE(story(result));
  EXPECT_EQ(round_of(result, "linear_drift"), nullptr);
  for (const DetectionLimit& limit : result.detection_limits)
    EXPECT_THAT(limit.effect, ::testing::AnyOf("slide_periodic", "centre_step"));
  for (const TriedEffect& tried : result.refused)
    EXPECT_THAT(tried.effect, ::testing::AnyOf("slide_periodic", "centre_step"));
}

TEST(Search, AddsNothingWhereNothingMayBeAdded) {
  Problem problem = small_problem();
  problem.trace.max_effects = 0;
  const Closed result = closed(problem, quarter_faces(drift(), 2, kBlunt, 5));
  EXPECT_THAT(result.rounds, ::testing::IsEmpty());
  EXPECT_EQ(values_of(result.final.parameters), values_of(result.declared.parameters));
}

TEST(Search, RefusesByItsSignificance) {
  Problem problem = small_problem();
  const std::vector<Profile> cuts = quarter_faces({"clean"}, 2, kBlunt, 5);
  const Closed result = closed(problem, cuts);
  SCOPED_TRACE(story(result));
  EXPECT_EQ(result.verdict, TraceVerdict::nothing_missing);
  EXPECT_EQ(result.detection_limits.size(), 3U);
  for (const DetectionLimit& limit : result.detection_limits)
    EXPECT_GT(limit.value.value_or(0.0), 0.0);
}

/// A level of a foot spacing of 200 mm, on eight stretches of a way.
std::vector<Profile> eight_readings(std::uint64_t seed) {
  constexpr double kBase = 200.0;
  RandomStream random(seed, "eight readings");
  std::vector<double> middles, slopes;
  for (int i = 0; i < 8; ++i) {
    middles.push_back(kBase * (i + 0.5));
    slopes.push_back(2e-5 * random.normal());
  }
  Profile out = cases::profile("way", Kind::slide, middles, slopes);
  out.setup.quantity = Quantity::slope;
  out.setup.base_mm = kBase;
  out.free_tilt = false;
  return {out};
}

// What may be missing is looked for with no more unknowns than there are readings to tell them, and
// no polynomial is raised to a degree that the stations do not carry.
TEST(FewReadings, AreSearchedForNoMoreThanTheyCanTell) {
  for (const int degree : {2, 3, 4, 5, 6})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      Problem problem = cases::problem(Lever::paper, 0, {cases::effect("straightness", degree)});
      problem.trace.candidates = effect_names();
      const Closed result = closed(problem, eight_readings(seed));
      SCOPED_TRACE(story(result));
      const FittedParameter& highest = result.final.parameters.back();
      if (round_of(result, "straightness") != nullptr) {
        EXPECT_TRUE(highest.identifiable) << highest.name;
      }
    }
}

}  // namespace
}  // namespace slideway
