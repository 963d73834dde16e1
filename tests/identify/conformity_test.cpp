#include "slideway/identify/conformity.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "identify/problem_file.hpp"
#include "slideway/base/file.hpp"
#include "slideway/identify/identify.hpp"

namespace slideway {
namespace {

QuantityValue measured(double value, double U) {
  QuantityValue out;
  out.value = value;
  out.expanded_uncertainty = U;
  return out;
}

// ISO 14253-1:2017, 5.2 and 5.3: U guards both zones.
TEST(Conformity, NeedsTheUncertaintyInsideTheLimitOrBeyondIt) {
  EXPECT_EQ(conformity_verdict(measured(2.9, 0.1), 3.0), ConformityVerdict::conforms);
  EXPECT_EQ(conformity_verdict(measured(2.95, 0.1), 3.0), ConformityVerdict::undecided);
  EXPECT_EQ(conformity_verdict(measured(3.05, 0.1), 3.0), ConformityVerdict::undecided);
  EXPECT_EQ(conformity_verdict(measured(3.2, 0.1), 3.0), ConformityVerdict::does_not_conform);
  EXPECT_EQ(conformity_verdict(measured(-3.2, 0.1), 3.0), ConformityVerdict::does_not_conform);
  EXPECT_EQ(conformity_verdict({}, 3.0), ConformityVerdict::undecided);
  EXPECT_EQ(conformity_verdict(measured(0.3, 0.1), 1.0, 0.5), ConformityVerdict::conforms);
  EXPECT_EQ(conformity_verdict(measured(0.3, 0.1), 1.0, 0.7), ConformityVerdict::undecided);
  EXPECT_EQ(conformity_verdict(measured(3.2, 0.1), 3.0, 0.7), ConformityVerdict::undecided);
}

class Toleranced : public ProblemFile {
 protected:
  /// A cone of 20 µm/m over a diameter of 200 mm, and an alternating error of 5 nm; a nub at the
  /// axis.
  [[nodiscard]] Result of_cone(const std::string& free, double nub_um = 0.0,
                               const std::string& more = "") {
    std::string text = "x_mm,z_um\n";
    for (int i = 0; i <= 200; ++i)
      text += std::to_string(i - 100) + "," +
              std::to_string(-0.02 * std::abs(i - 100) + (i % 2 == 0 ? 0.005 : -0.005) +
                             (i == 100 ? nub_um : 0.0)) +
              "\n";
    write_file(folder_.path() / "cone.csv", text);
    const Problem problem = read(
        "[tolerance]\nflatness_um = 2.5\nsquareness_um_per_m = 10\nstraightness_um = 1\n"
        "[about]\nmachine = \"LT-3\"\n[machine]\nlever = \"paper\"\n[low_band]\nlevel = 0\n"
        "[[profile]]\nname = \"cone\"\nfile = \"cone.csv\"\nfree = " +
        free + "\n" + more + "[[effect]]\nname = \"squareness\"\n");
    return identify(problem, read_profiles(problem));
  }
};

TEST_F(Toleranced, AFaceIsHeldAgainstItsLimits) {
  const Result result = of_cone(R"(["offset", "tilt"])");
  EXPECT_EQ(result.about.at("machine"), "LT-3");
  ASSERT_EQ(result.conformity.size(), 3U);
  // 0.02 µm/mm over 100 mm; the axis itself is left out, a groove at most: 0.02 µm, twice the
  // error.
  EXPECT_NEAR(*result.conformity[0].value_um, 2.0, 0.04);
  EXPECT_EQ(result.conformity[0].verdict, ConformityVerdict::conforms);
  EXPECT_EQ(result.conformity[1].verdict, ConformityVerdict::undecided);  // not in the model
  EXPECT_FALSE(result.conformity[1].value_um);
  EXPECT_NEAR(*result.conformity[2].value_um_per_m, 20.0, 0.1);
  EXPECT_EQ(result.conformity[2].verdict, ConformityVerdict::does_not_conform);
}

// The fit leaves the axis out, the workpiece has it: 2 µm of the cone and 1.5 µm above its tip.
TEST_F(Toleranced, ANubThatTheFitLeavesOutIsPartOfTheFlatness) {
  const Conformity flatness = of_cone(R"(["offset", "tilt"])", 1.5).conformity[0];
  EXPECT_LT(*flatness.value_um + *flatness.U_um, 2.5);
  EXPECT_NEAR(flatness.with_left_out_um.value_or(0.0), 3.5, 0.04);
  EXPECT_EQ(flatness.verdict, ConformityVerdict::undecided);
}

// A trace of 6 mm within the first groove, 24 mm wide: none of its values is fitted.
TEST_F(Toleranced, AFaceOfWhichNothingIsFittedHasNoFlatness) {
  std::string text = "x_mm,z_um\n";
  for (int i = 0; i <= 20; ++i)
    text += std::to_string(0.3 * i - 3.0) + "," + std::to_string(0.01 * (i % 3)) + "\n";
  write_file(folder_.path() / "middle.csv", text);
  const Result result = of_cone(R"(["offset", "tilt"])", 0.0,
                                "[[profile]]\nname = \"middle\"\nfile = \"middle.csv\"\n"
                                "feed_mm_per_min = 2400\nspindle_rpm = 100\n");
  EXPECT_NEAR(*result.conformity[0].value_um, 2.0, 0.04);
}

}  // namespace
}  // namespace slideway
