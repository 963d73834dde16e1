// Effects of the catalogue with a clock of their own get their one name, with the shape they had.

#include <cmath>

#include "slideway/base/units.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using ::testing::HasSubstr;
using turning::Hidden;
using turning::ToolPoint;

Closed close_on(const Hidden& hidden, int cuts, double nose_radius, std::uint64_t seed) {
  return closed(problem_of(), quarter_faces(hidden, cuts, nose_radius, seed));
}

void expect_only(const TraceResult& result, const std::string& effect) {
  EXPECT_THAT(named(result), ::testing::ElementsAre(effect));
  const TraceRound* round = round_of(result, effect);
  ASSERT_NE(round, nullptr);
  EXPECT_THAT(round->ambiguous_with, ::testing::IsEmpty());
  EXPECT_LT(round->after_rms_um, round->before_rms_um);
  EXPECT_LE(round->delta_bic, -10.0);
  EXPECT_LE(round->p_value, 0.01);
}

TEST(Named, StepAtTheSampleWhereItIs) {
  const double place = 4.3717;
  Problem problem = problem_of();
  problem.low_band.level = 5;
  const turning::Hidden step{"step",
                             [=](const ToolPoint& p) { return p.r < place ? 0.1e-3 : 0.0; }};
  const Closed result = closed(problem, turning::make_faces(step, 2, kSharp, 3));
  SCOPED_TRACE(story(result));
  expect_only(result, "step");
  const TraceRound* round = round_of(result, "step");
  ASSERT_NE(round, nullptr);
  // A cut has it between two grooves of its own (8 mm/min: 0.073 mm, 2 mm/min: 0.018 mm), and a
  // low-band value is 32 samples long.
  const FittedParameter* position = find(round->parameters, "step.position_mm");
  ASSERT_NE(position, nullptr);
  EXPECT_NEAR(*position->value, place, 2.0 / 110.0 + 0.032);
  expect_within_4u(round->parameters, "step.height_um", 0.1);
}

TEST(Named, SlidePeriodicOfAPeriodOffTheGrid) {
  const double period = 2.7183;
  const Closed result = close_on(
      {"slide_periodic",
       [=](const ToolPoint& p) { return 0.1e-3 * std::cos(2.0 * kPi * p.x / period + 0.4); }},
      2, kBlunt, 4);
  SCOPED_TRACE(story(result));
  expect_only(result, "slide_periodic");
  const TraceRound* round = round_of(result, "slide_periodic");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "slide_periodic.period_mm", period);
  expect_within_4u(round->parameters, "slide_periodic.amplitude_um", 0.1);
}

// A face off its centre has a step that goes with its slope, and this one is curved.
TEST(Named, CentreStep) {
  const Closed result = close_on(
      {"centre_step", nullptr, [](double X, double) { return X < 0.0 ? -0.05e-3 : 0.05e-3; }}, 2,
      kBlunt, 5);
  SCOPED_TRACE(story(result));
  expect_only(result, "centre_step");
  const TraceRound* round = round_of(result, "centre_step");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "centre_step.height_um", 0.05);
}

// As smooth as it is, it must be far above the spread of the trace, or a long memory of the noise
// is as likely.
TEST(Named, TraverseDatum) {
  const Closed result = close_on({"traverse_datum", nullptr,
                                  [](double X, double) {
                                    const double u = X / 10.0;
                                    return 0.4e-3 * u * u * u;
                                  }},
                                 2, kBlunt, 6);
  SCOPED_TRACE(story(result));
  expect_only(result, "traverse_datum");
  const TraceRound* round = round_of(result, "traverse_datum");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "traverse_datum.amplitude_um", 0.4);
}

TEST(Named, EdgeRollOff) {
  const Closed result = close_on(
      {"edge_roll_off", [](const ToolPoint& p) { return -0.3e-3 * std::exp((p.r - 10.0) / 0.23); }},
      3, kSharp, 8);
  SCOPED_TRACE(story(result));
  expect_only(result, "edge_roll_off");
  const TraceRound* round = round_of(result, "edge_roll_off");
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, "edge_roll_off.width_mm", 0.23);
}

// 3 µm at the rim that grow with r⁴; with one lever a coefficient b_4 makes -3 b_4 r⁴.
TEST(Named, StraightnessOfMoreTermsThanDeclared) {
  const Closed result =
      close_on({"quartic", [](const ToolPoint& p) { return 3e-3 * std::pow(p.r / 10.0, 4); }}, 2,
               kBlunt, 10);
  SCOPED_TRACE(story(result));
  expect_only(result, "straightness");
  EXPECT_EQ(find(result.declared.parameters, "straightness.b4"), nullptr);
  expect_within_4u(result.final.parameters, "straightness.b4", -1e-7);
  expect_within_4u(result.final.parameters, "squareness.dbeta_xz", turning::kFaceSquareness);
}

// Both are steep at the centre, where a nose of 2 mm does not follow: the wrong one is never named
// alone, and what it had bent is straight again.
TEST(Named, WhatIsSteepAtTheCentreIsNoOtherAlone) {
  for (const std::uint64_t seed : {106, 107}) {
    RandomStream random(seed, "speed_effect");
    const Closed result =
        close_on(turning::make_hidden("speed_effect", 0.15e-3, random), 3, kSharp, seed);
    SCOPED_TRACE(story(result));
    std::vector<std::string> set = named(result);
    for (const TraceRound& round : result.rounds)
      set.insert(set.end(), round.ambiguous_with.begin(), round.ambiguous_with.end());
    if (!result.unnamed) {
      EXPECT_THAT(set, ::testing::Contains("speed_effect"));
    }
    expect_within_4u(result.final.parameters, "squareness.dbeta_xz", turning::kFaceSquareness);
  }
}

// One spindle speed in all cuts: time and revolutions are one clock. Of 0.1 um a nose of 50 mm
// would make a second harmonic of 50 mm/4 (2π 0.1 um/0.9 mm)² = 6 nm, a line of its own.
TEST(Named, TimeAndRevolutionsAreOneClockAtOneSpeed) {
  const Closed result = close_on(
      {"time_periodic",
       [](const ToolPoint& p) { return 0.05e-3 * std::cos(2.0 * kPi * p.t / 27.18 + 0.9); }},
      2, kBlunt, 9);
  SCOPED_TRACE(story(result));
  EXPECT_EQ(result.verdict, TraceVerdict::ambiguous);
  ASSERT_EQ(named(result).size(), 1U);
  const std::string name = named(result)[0];
  const std::string other = name == "time_periodic" ? "revolution_periodic" : "time_periodic";
  EXPECT_THAT(name, ::testing::AnyOf("time_periodic", "revolution_periodic"));
  EXPECT_THAT(round_of(result, name)->ambiguous_with, ::testing::Contains(other));
  EXPECT_THAT(result.advice, ::testing::Contains(HasSubstr("rev/min")));
}

// 0.4 µm, 40 times the noise: its grooves overlap, and no law describes it to its last hundredth.
// One cut does not tell of a strong wave, either, whether it is of the slide or of the spindle.
TEST(Named, AStrongWaveOfOneCutIsOfTheSlideOrOfTheSpindle) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    RandomStream random(seed, "revolution_periodic");
    const turning::Hidden hidden = turning::make_hidden("revolution_periodic", 0.4e-3, random);
    const Closed result =
        closed(problem_of({"revolution_periodic", "slide_periodic", "traverse_periodic"}),
               quarter_faces(hidden, 1, kSharp, seed));
    SCOPED_TRACE(story(result));
    ASSERT_FALSE(named(result).empty());
    std::vector<std::string> set = result.rounds[0].ambiguous_with;
    set.push_back(result.rounds[0].accepted);
    EXPECT_THAT(set, ::testing::IsSupersetOf({"revolution_periodic", "slide_periodic"}));
  }
}

}  // namespace
}  // namespace slideway
