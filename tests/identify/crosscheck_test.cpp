#include "slideway/identify/crosscheck.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "identify/cases.hpp"

namespace slideway {
namespace {

using ::testing::HasSubstr;

// Section 5.3 of the paper: r = 0.3 µm, p = 2.5 µm over D = 1000 mm.
constexpr Runout kRunout{
    .r_um = 0.3, .p_um = 2.5, .diameter_mm = 1000.0, .standard_uncertainty_um = 0.1};

const std::vector<Profile>& one_face() {
  static const std::vector<Profile> profiles{
      cases::face("face", 2.0, cases::spaced(0.0, 10.0, 64), std::vector<double>(64, 0.0))};
  return profiles;
}

Model model() {
  return build_model(cases::problem(Lever::paper, 0, {cases::effect("squareness")}), one_face());
}

ModelResult fit_with(double squareness, double expanded) {
  ModelResult fit;
  FittedParameter parameter;
  parameter.name = "squareness.dbeta_xz";
  parameter.value = squareness;
  parameter.expanded_uncertainty = expanded;
  fit.parameters.push_back(parameter);
  return fit;
}

TEST(SquarenessCheck, TakesTheAngleFromTheRunout) {
  // Eq. (21): (0.3 + 2.5) µm / 1000 mm = 2.8e-6 rad; U = 2 · 0.1 µm / 1000 mm.
  const SquarenessCheck check = check_squareness(model(), kRunout, fit_with(2.8e-6, 1e-7));
  EXPECT_NEAR(*check.indirect_rad, 2.8e-6, 1e-20);
  EXPECT_NEAR(*check.indirect_U_rad, 2e-7, 1e-21);
  EXPECT_NEAR(*check.En, 0.0, 1e-12);
  EXPECT_EQ(check.verdict, Consistency::consistent);
  // Over the 10 mm that were cut: 28 nm.
  EXPECT_EQ(check.travel_mm, 10.0);
  EXPECT_NEAR(*check.indirect_amplitude_um, 0.028, 1e-15);
}

TEST(SquarenessCheck, DividesTheDifferenceByBothUncertainties) {
  // |3.3e-6 - 2.8e-6| / sqrt((1.5e-7)² + (2e-7)²) = 5e-7 / 2.5e-7 = 2.
  const SquarenessCheck check = check_squareness(model(), kRunout, fit_with(3.3e-6, 1.5e-7));
  EXPECT_NEAR(*check.En, 2.0, 1e-12);
  EXPECT_EQ(check.verdict, Consistency::inconsistent);
  EXPECT_THAT(check.reason, HasSubstr("look for another cause"));
  // 3.0e-6: E_n = 0.8.
  EXPECT_NEAR(*check_squareness(model(), kRunout, fit_with(3.0e-6, 1.5e-7)).En, 0.8, 1e-12);
}

TEST(SquarenessCheck, ComparesMagnitudesAsARunoutHasNoSign) {
  const SquarenessCheck check = check_squareness(model(), kRunout, fit_with(-2.8e-6, 1e-7));
  EXPECT_NEAR(*check.En, 0.0, 1e-12);
  EXPECT_EQ(*check.fit_rad, -2.8e-6);
}

TEST(SquarenessCheck, SaysWhyItIsNotAvailable) {
  const SquarenessCheck no_runout = check_squareness(model(), std::nullopt, fit_with(2.8e-6, 1e-7));
  EXPECT_EQ(no_runout.verdict, Consistency::not_available);
  EXPECT_THAT(no_runout.reason, HasSubstr("[runout]"));
  EXPECT_FALSE(no_runout.En || no_runout.indirect_rad);

  EXPECT_THAT(check_squareness(model(), kRunout, {}).reason, HasSubstr("declares no squareness"));

  ModelResult undetermined = fit_with(0.0, 0.0);
  undetermined.parameters[0].identifiable = false;
  undetermined.parameters[0].value.reset();
  const SquarenessCheck unknown = check_squareness(model(), kRunout, undetermined);
  EXPECT_EQ(unknown.verdict, Consistency::not_available);
  EXPECT_THAT(unknown.reason, HasSubstr("do not determine"));
  EXPECT_FALSE(unknown.fit_rad || unknown.En);
  EXPECT_TRUE(unknown.indirect_rad);  // what the run-out says is told all the same
}

}  // namespace
}  // namespace slideway
