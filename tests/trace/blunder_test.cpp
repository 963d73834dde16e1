#include "blunder.hpp"

#include <gtest/gtest.h>

#include <random>

#include "identify/cases.hpp"

namespace slideway {
namespace {

constexpr double kTraceNoise = 3e-5;  // mm

/// A cone of 10 µm over 60 mm with white noise.
Profile cut(const std::string& name, unsigned seed, double factor = 1.0,
            double deviation = kTraceNoise) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> noise(0.0, deviation);
  const std::vector<double> x = cases::spaced(2.0, 60.0, 300);
  std::vector<double> z;
  for (const double r : x)
    z.push_back(factor * (-1e-2 * r / 60.0 - 4e-3 * std::pow(r / 60.0, 2) + noise(engine)));
  return cases::face(name, 8.0, x, z);
}

std::vector<Blunder> found(const std::vector<Profile>& profiles) {
  return find_blunders(
      fit_declared(cases::problem(Lever::paper, 0,
                                  {cases::effect("squareness"), cases::effect("straightness", 3)}),
                   profiles));
}

TEST(Blunder, NoneIsSeenInCutsThatAgree) {
  for (unsigned seed = 0; seed < 20; ++seed)
    EXPECT_TRUE(
        found({cut("a", 3 * seed), cut("b", 3 * seed + 1), cut("c", 3 * seed + 2)}).empty());
}

TEST(Blunder, ANoisyCutHasNoBlunder) {
  Profile noisy = cut("b", 2);
  std::mt19937_64 engine(9);
  std::normal_distribution<double> noise(0.0, 10.0 * kTraceNoise);
  for (double& each : noisy.values) each += noise(engine);
  EXPECT_TRUE(found({cut("a", 1), noisy, cut("c", 3)}).empty());
}

class BlunderOf : public ::testing::TestWithParam<std::pair<double, BlunderKind>> {};

TEST_P(BlunderOf, OneCutIsNamedWithItsCut) {
  const auto [factor, kind] = GetParam();
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto blunders =
        found({cut("a", 3 * seed), cut("b", 3 * seed + 1, factor), cut("c", 3 * seed + 2)});
    ASSERT_EQ(blunders.size(), 1U) << "seed " << seed;
    EXPECT_EQ(blunders[0].profile, "b");
    EXPECT_EQ(blunders[0].what, kind);
  }
}

INSTANTIATE_TEST_SUITE_P(Factors, BlunderOf,
                         ::testing::Values(std::pair{-1.0, BlunderKind::sign},
                                           std::pair{25.4, BlunderKind::per_inch},
                                           std::pair{1 / 25.4, BlunderKind::inch},
                                           std::pair{1000.0, BlunderKind::per_metre},
                                           std::pair{1e-3, BlunderKind::metre}));

// Its own noise is unlike that of the others, but 25 times less so once the unit is right.
TEST(Blunder, ANoisyCutInAnotherUnitIsNamed) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const auto blunders =
        found({cut("a", 3 * seed), cut("b", 3 * seed + 1, 25.4, 8.0 * kTraceNoise),
               cut("c", 3 * seed + 2)});
    ASSERT_EQ(blunders.size(), 1U) << "seed " << seed;
    EXPECT_EQ(blunders[0].profile, "b");
    EXPECT_EQ(blunders[0].what, BlunderKind::per_inch);
  }
}

class PositionUnit : public ::testing::TestWithParam<std::pair<double, BlunderKind>> {};

TEST_P(PositionUnit, OfOneCutIsNamedWithItsCut) {
  const auto [factor, kind] = GetParam();
  for (unsigned seed = 0; seed < 10; ++seed) {
    Profile wrong = cut("b", 3 * seed + 1);
    for (double& each : wrong.positions) each *= factor;
    wrong = cases::face("b", 8.0, wrong.positions, wrong.values);
    const auto blunders = found({cut("a", 3 * seed), wrong, cut("c", 3 * seed + 2)});
    ASSERT_EQ(blunders.size(), 1U) << "seed " << seed;
    EXPECT_EQ(blunders[0].profile, "b");
    EXPECT_EQ(blunders[0].what, kind);
  }
}

INSTANTIATE_TEST_SUITE_P(Factors, PositionUnit,
                         ::testing::Values(std::pair{1e-3, BlunderKind::position_metre},
                                           std::pair{1000.0, BlunderKind::position_per_metre},
                                           std::pair{1 / 25.4, BlunderKind::position_inch},
                                           std::pair{25.4, BlunderKind::position_per_inch}));

TEST(Blunder, AShortTraceIsInNoOtherUnit) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Profile part = cut("b", 3 * seed + 1);
    part.positions.resize(40);
    part.values.resize(40);
    part = cases::face("b", 8.0, part.positions, part.values);
    EXPECT_TRUE(found({cut("a", 3 * seed), part, cut("c", 3 * seed + 2)}).empty()) << seed;
  }
}

// A convex and a concave straightedge: forms of their own, not one in two signs.
TEST(Blunder, NoneIsSeenInReadingsOfDifferentSurfaces) {
  const std::vector<double> x = cases::spaced(0.0, 400.0, 200);
  std::vector<Profile> readings;
  for (const auto& [name, bow] : {std::pair{"convex", 5e-4}, std::pair{"concave", -5e-4}}) {
    std::mt19937_64 engine(readings.size());
    std::normal_distribution<double> noise(0.0, kTraceNoise);
    std::vector<double> z;
    for (const double each : x) z.push_back(bow * std::pow(each / 200.0 - 1.0, 2) + noise(engine));
    readings.push_back(cases::profile(name, Kind::slide, x, z));
  }
  const auto of_slide = [&] {
    return find_blunders(fit_declared(
        cases::problem(Lever::paper, 0, {cases::effect("straightness", 4)}), readings));
  };
  EXPECT_FALSE(of_slide().empty());  // of one slide one of them is the wrong way round
  for (Profile& reading : readings) reading.surface = reading.name;
  EXPECT_TRUE(of_slide().empty());
}

TEST(Blunder, OfTwoCutsEitherMayHaveTheWrongSign) {
  const auto blunders = found({cut("a", 1), cut("b", 2, -1.0)});
  ASSERT_EQ(blunders.size(), 2U);
  EXPECT_EQ(blunders[0].what, BlunderKind::sign);
  EXPECT_EQ(blunders[1].what, BlunderKind::sign);
  EXPECT_NE(blunders[0].profile, blunders[1].profile);
}

}  // namespace
}  // namespace slideway
