#include "slideway/effects/catalogue.hpp"

#include <gmock/gmock.h>

#include "effects/effect_cases.hpp"
#include "slideway/base/error.hpp"

namespace slideway::catalogue_test {
namespace {

using namespace testing_support;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusal(const std::string& name, const EffectOptions& options,
                    const Machine& machine = lathe()) {
  try {
    (void)make_effect(name, options, machine, kTravel);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<std::string> parameter_names(const std::string& name, int degree = 5) {
  std::vector<std::string> names;
  const auto effect = make(name, kTravel, Lever::paper, degree);
  for (const Parameter& p : effect->parameters()) names.push_back(p.name + " " + p.unit);
  return names;
}

TEST(Catalogue, HoldsTheEffectsOfTheInterface) {
  EXPECT_THAT(effect_names(),
              ElementsAre("straightness", "vertical_straightness", "squareness", "linear_drift",
                          "thermal_drift", "time_periodic", "tool_wear", "tool_running_in",
                          "slide_periodic", "gantry_sag", "revolution_periodic", "spindle_runout",
                          "feed_marks", "step", "centre_height", "speed_effect", "edge_roll_off",
                          "cup", "traverse_datum", "centre_step", "traverse_periodic",
                          "chucking_lobes", "local_form", "centring", "chord", "hysteresis",
                          "zero_drift", "instrument_zero", "artefact_form"));
}

TEST(Catalogue, TellsTheErrorsOfTheCarriagesByTermAndParameter) {
  EXPECT_EQ(motion_error_of("straightness[upper].b2"), MotionError::straightness);
  EXPECT_EQ(motion_error_of("vertical_straightness.c1"), MotionError::vertical_straightness);
  EXPECT_EQ(motion_error_of("squareness"), MotionError::squareness);
  EXPECT_EQ(motion_error_of("gantry_sag.sag_um"), MotionError::none);
  EXPECT_EQ(motion_error_of("coolant.a"), MotionError::none);
}

TEST(Catalogue, HoldsOffsetAndSlopeOfAStraightnessForConventionsAlone) {
  for (const char* fixed : {"straightness.b0", "straightness.b1", "straightness[upper].b0"})
    EXPECT_TRUE(fixed_by_convention(fixed)) << fixed;
  for (const char* data : {"straightness.b2", "straightness.b10", "vertical_straightness.c1",
                           "squareness.dbeta_xz", "coolant.b0"})
    EXPECT_FALSE(fixed_by_convention(data)) << data;
}

TEST(Catalogue, MakesTheEffectOfAReportsParameters) {
  const auto effect = make_effect_with("straightness", {"b2", "b4"}, lathe(), {});
  EXPECT_EQ(effect->parameters().size(), 5U);
  EXPECT_THROW((void)make_effect_with("straightness", {"c1"}, lathe(), {}), UsageError);
}

TEST(Catalogue, NamesParametersAsTheProblemFileDoes) {
  EXPECT_THAT(parameter_names("straightness", 3),
              ElementsAre("b0 mm", "b1 1", "b2 mm^-1", "b3 mm^-2"));
  EXPECT_THAT(parameter_names("vertical_straightness", 2), ElementsAre("c1 1", "c2 mm^-1"));
  EXPECT_THAT(parameter_names("squareness"), ElementsAre("dbeta_xz rad"));
  EXPECT_THAT(parameter_names("linear_drift"), ElementsAre("rate_um_per_min µm/min"));
  EXPECT_THAT(parameter_names("thermal_drift"),
              ElementsAre("amplitude_um µm", "time_constant_s s"));
  EXPECT_THAT(parameter_names("time_periodic"),
              ElementsAre("amplitude_um µm", "period_s s", "phase_rad rad"));
  EXPECT_THAT(parameter_names("tool_wear"), ElementsAre("rate_um_per_m µm/m"));
  EXPECT_THAT(parameter_names("tool_running_in"), ElementsAre("amplitude_um µm", "distance_m m"));
  EXPECT_THAT(parameter_names("slide_periodic"),
              ElementsAre("amplitude_um µm", "period_mm mm", "phase_rad rad"));
  EXPECT_THAT(parameter_names("revolution_periodic"),
              ElementsAre("amplitude_um µm", "cycles_per_revolution 1", "phase_rad rad"));
  EXPECT_THAT(parameter_names("traverse_periodic"),
              ElementsAre("amplitude_um µm", "frequency_hz Hz", "phase_rad rad"));
  EXPECT_THAT(parameter_names("step"), ElementsAre("height_um µm", "position_mm mm"));
  EXPECT_THAT(parameter_names("centre_height"), ElementsAre("amplitude_um µm", "height_mm mm"));
  EXPECT_THAT(parameter_names("speed_effect"), ElementsAre("amplitude_um µm", "exponent 1"));
  EXPECT_THAT(parameter_names("edge_roll_off"), ElementsAre("amplitude_um µm", "width_mm mm"));
  EXPECT_THAT(parameter_names("gantry_sag"), ElementsAre("sag_um µm"));
  EXPECT_THAT(parameter_names("cup"), ElementsAre("sag_um µm"));
  EXPECT_THAT(parameter_names("centre_step"), ElementsAre("height_um µm"));
}

TEST(Catalogue, RefusesANameItDoesNotHold) {
  EXPECT_THAT(refusal("squarness", {}), HasSubstr("squareness"));
}

TEST(Catalogue, RefusesOptionsTheEffectDoesNotTake) {
  EXPECT_THAT(refusal("cup", {.body = {}, .degree = 2, .span_mm = {}}),
              HasSubstr("'degree' is not an option of it; accepted: none"));
  EXPECT_THAT(refusal("straightness", {.body = {}, .degree = 2, .span_mm = 10.0}),
              HasSubstr("'span_mm' is not an option of it; accepted: body, degree"));
}

TEST(Catalogue, EveryEffectChecksItsOptions) {
  // No effect takes all three options.
  const EffectOptions all{.body = "x_carriage", .degree = 2, .span_mm = 700.0};
  for (const std::string& name : effect_names())
    EXPECT_THAT(refusal(name, all), HasSubstr("is not an option of it")) << name;
}

TEST(Catalogue, RefusesOptionsThatAreMissingOrOutOfRange) {
  EXPECT_THAT(refusal("straightness", {}), HasSubstr("'degree' is missing; accepted: 0 to 20"));
  EXPECT_THAT(refusal("vertical_straightness", {.body = {}, .degree = 0, .span_mm = {}}),
              HasSubstr("accepted: 1 to 20"));
  EXPECT_THAT(refusal("gantry_sag", {}), HasSubstr("'span_mm' is needed"));
  EXPECT_THAT(refusal("gantry_sag", {.body = {}, .degree = {}, .span_mm = -1.0}),
              HasSubstr("above 0"));
}

TEST(Catalogue, RefusesBodiesThatDoNotCarryTheToolAlongTheAxis) {
  EXPECT_THAT(refusal("squareness", {.body = "z_carriage", .degree = {}, .span_mm = {}}),
              HasSubstr("does not carry the tool along x; accepted: x_carriage"));
  EXPECT_THAT(refusal("squareness", {.body = "turret", .degree = {}, .span_mm = {}}),
              HasSubstr("no body 'turret'"));
  const Machine two({{"cross", 0, Axis::x}, {"fine", 1, Axis::x}}, Lever::paper);
  EXPECT_THAT(refusal("squareness", {}, two), HasSubstr("'body' is needed"));
  EXPECT_EQ(refusal("squareness", {.body = "fine", .degree = {}, .span_mm = {}}, two), "accepted");
  EXPECT_THAT(refusal("vertical_straightness", {.body = {}, .degree = 2, .span_mm = {}}, two),
              HasSubstr("moves along z"));
}

}  // namespace
}  // namespace slideway::catalogue_test
