// The closed loop on data that were really measured.

#include "problems/shipped.hpp"
#include "slideway/identify/identify.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)

Closed close_problem(const std::string& name) {
  const Problem problem = shipped_problem(name);
  return closed(problem, read_profiles(problem));
}

class Measured : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(measured_data()))
      GTEST_SKIP() << "no " << measured_data().string() << "; set SLIDEWAY_DATA";
  }
};

TEST_F(Measured, TestBarRunsOut) {
  const Closed result = close_problem("real/test-bar.toml");
  SCOPED_TRACE(story(result));
  ASSERT_FALSE(result.rounds.empty());
  const TraceRound& first = result.rounds.front();
  EXPECT_EQ(first.accepted, "spindle_runout");
  ASSERT_TRUE(first.before_rms_um);
  // numpy.polyfit: 9.459, the least that a cubic leaves; the estimate under the noise leaves more.
  EXPECT_NEAR(*first.before_rms_um, 9.459, 0.01 * 9.459);
  // Least squares apart from this: 4.61 µm at a constant speed, 2.02 with the angle a quadratic in
  // time, 1.09 at degree 4, 1.07 at degree 5. What is beside the turn is its modulation.
  EXPECT_LE(*first.after_rms_um, 1.2);
  EXPECT_EQ(result.rounds.size(), 1U);
  const FittedParameter* speed = find(first.parameters, "spindle_runout.rpm");
  ASSERT_NE(speed, nullptr);
  EXPECT_NEAR(*speed->value, 2.576, 0.01);  // the same: 186.75 turns in 4349.9 s
  // Every other of 40 blocks left out: 1.114 µm, by the same.
  ASSERT_FALSE(result.cross_validation.empty());
  EXPECT_NEAR(result.cross_validation[0].block_mm, 259.7 / 40.0, 0.01);
  EXPECT_LE(*result.cross_validation[0].after_rms_um, 1.3);
}

TEST_F(Measured, LatheBedHasNoEffectOfTheSlide) {
  const Closed result = close_problem("real/lathe-bed.toml");
  SCOPED_TRACE(story(result));
  EXPECT_THAT(result.rounds, ::testing::IsEmpty());
}

/// Runs of the lathe bed with a polynomial, by index from run 2.
Closed close_bed(int degree, const std::vector<std::size_t>& runs) {
  Problem problem = bed_as_polynomial(degree);
  std::vector<ProfileEntry> kept;
  for (const std::size_t run : runs) kept.push_back(problem.profiles.at(run));
  problem.profiles = std::move(kept);
  return closed(problem, read_profiles(problem));
}

// A polynomial that is cut short leaves waves, which are no effect.
TEST_F(Measured, LatheBedHasNoWaveAtAnyDegree) {
  const std::vector<std::vector<std::size_t>> choices{{0, 1, 2, 3}, {0}, {1}, {2}, {3}};
  for (int degree = 4; degree <= 16; ++degree)
    for (const std::vector<std::size_t>& runs : choices) {
      const Closed result = close_bed(degree, runs);
      SCOPED_TRACE(std::to_string(degree) + ": " + story(result));
      for (const TraceRound& round : result.rounds) EXPECT_EQ(round.accepted, "straightness");
      // A form deviates from its line by a quarter of the travel times the range of its slope at
      // most: of the run with the least range, 221 µrad over 1.19 m.
      ASSERT_TRUE(result.final.straightness && result.final.straightness->expanded_uncertainty_um);
      EXPECT_LT(*result.final.straightness->expanded_uncertainty_um, 0.25 * 221.0 * 1.19);
    }
}

// A plane mirror declared straight: its curvature comes back, and what is left is the slope error
// the laboratory states without it (0.31849 µrad with n instead of n - 1).
TEST_F(Measured, CurvatureOfAMirrorDeclaredStraightComesBack) {
  Problem problem = shipped_problem("real/mirror-plane.toml");
  const std::vector<Profile> profiles = read_profiles(problem);
  const Result declared = identify(problem, profiles, Scope::fit);
  problem.effects.at(0).options.degree = 1;
  const Closed result = closed(problem, profiles);
  SCOPED_TRACE(story(result));
  ASSERT_FALSE(result.rounds.empty());
  EXPECT_EQ(result.rounds[0].accepted, "straightness");
  ASSERT_TRUE(result.rounds[0].after_rms_urad);
  // By least squares; under correlated noise the estimate is another one, and by a thousandth of u
  // the rms rises by as little.
  EXPECT_NEAR(*result.rounds[0].after_rms_urad, 0.31849, 0.001 * 0.31849);
  ASSERT_TRUE(declared.final);
  const FittedParameter* b2 = find(declared.final->parameters, "straightness.b2");
  ASSERT_NE(b2, nullptr);
  expect_within_4u(result.final.parameters, "straightness.b2", *b2->value);
}

// What is left without a name is a part of the residual, not of what the parameters take.
TEST_F(Measured, StructureWithoutANameIsNoLargerThanTheResidual) {
  Problem problem = shipped_problem("real/lathe-bed.toml");
  problem.effects.front().options.degree = 4;  // too few: the bed was bent in one place
  problem.trace.max_effects = 0;
  const Closed result = closed(problem, read_profiles(problem));
  SCOPED_TRACE(story(result));
  ASSERT_TRUE(result.unnamed);
  ASSERT_TRUE(result.final.rms_urad);
  EXPECT_LT(*result.unnamed->rms_urad, *result.final.rms_urad);
}

TEST(Shipped, ThreeLevelsLackNothing) {
  const Closed result = close_problem("three-levels/problem.toml");
  SCOPED_TRACE(story(result));
  EXPECT_EQ(result.verdict, TraceVerdict::nothing_missing);
}

}  // namespace
}  // namespace slideway
