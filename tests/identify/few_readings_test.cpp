// Profiles with so few readings that form, noise and drift are hard to tell from one another: a
// level on a surface plate, positions of a machine's axis. The truth is a bow, or none.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/identify.hpp"

namespace slideway {
namespace {

constexpr double kStep = 50.0, kBase = 94.9;  // mm
constexpr double kMicroradians = 1e-6;

/// A level read at even places and times along a bow whose slope changes by 40 µrad.
Profile level(int stations, double noise, RandomStream& random) {
  const std::vector<double> positions =
      cases::spaced(0.0, kStep * (stations - 1), static_cast<std::size_t>(stations));
  std::vector<double> slopes, times;
  for (const double x : positions) {
    slopes.push_back(kMicroradians *
                     (40.0 * (x / positions.back() - 0.5) + noise * random.normal()));
    times.push_back(0.6 * x);
  }
  Profile out = cases::profile("level", Kind::slide, positions, slopes);
  out.setup.quantity = Quantity::slope;
  out.setup.base_mm = kBase;
  out.setup.reading_times = std::make_shared<const ReadingTimes>(ReadingTimes{positions, times});
  out.free_tilt = false;
  return out;
}

/// Height of that bow over the chord through the outer feet, µm: its curvature times length² / 8.
double bow_um(int stations) {
  const double readings = kStep * (stations - 1), length = readings + kBase;
  return 40e-6 / readings * length * length / 8.0 * 1e3;
}

Result identified(const Profile& profile, bool drift) {
  DeclaredEffect curve = cases::effect("straightness");
  curve.options.form = Form::curve;
  curve.options.resolution_mm = kStep;
  std::vector<DeclaredEffect> effects{curve};
  if (drift) effects.push_back(cases::effect("zero_drift"));
  return identify(cases::problem(Lever::paper, 0, effects), {profile}, Scope::fit);
}

bool holds(const Straightness& form, double truth_um) {
  return std::abs(*form.end_point_um - truth_um) <= *form.expanded_uncertainty_um;
}

// Read at an even pace, a drift of the zero and a bow are one column.
TEST(FewReadings, ABowThatMayBeADriftIsLeftOpen) {
  for (int seed = 0; seed < 20; ++seed) {
    RandomStream random(static_cast<std::uint64_t>(seed), "bow or drift");
    const Result result = identified(level(9, 0.3, random), true);
    const Straightness& form = *result.final->straightness;
    EXPECT_TRUE(holds(form, bow_um(9))) << seed;
    EXPECT_GT(*form.expanded_uncertainty_um, 0.5 * bow_um(9)) << seed;
  }
}

// Of 60 intervals of 95 % at most 7 miss once in 60 times (binomial); the seeds are fixed.
TEST(FewReadings, UOfACurveHoldsTheForm) {
  int held = 0;
  for (const int stations : {6, 9, 15})
    for (int seed = 0; seed < 20; ++seed) {
      RandomStream random(static_cast<std::uint64_t>(seed), "few" + std::to_string(stations));
      const Result result = identified(level(stations, 1.0, random), false);
      EXPECT_TRUE(result.final->converged);
      held += holds(*result.final->straightness, bow_um(stations)) ? 1 : 0;
    }
  EXPECT_GE(held, 53);
}

// Ten cycles over five positions, a polynomial through each: alone none has a noise of its own.
TEST(FewReadings, ProfilesWithoutAValueToSpareAgreeByTheNoiseOfAll) {
  std::vector<Profile> cycles;
  for (int i = 0; i < 10; ++i) {
    RandomStream random(static_cast<std::uint64_t>(i), "cycles");
    std::vector<double> heights;
    for (int k = 0; k < 5; ++k) heights.push_back(0.01 * k * (4 - k) + 1e-3 * random.normal());
    cycles.push_back(cases::profile("cycle" + std::to_string(i), Kind::slide,
                                    cases::spaced(0.0, 400.0, 5), heights));
  }
  const Result result =
      identify(cases::problem(Lever::paper, 0, {cases::effect("straightness", 4)}), cycles);
  ASSERT_FALSE(result.crosscheck.profiles.empty());
  for (const ProfileCheck& check : result.crosscheck.profiles) EXPECT_LT(*check.En, 1.0);
}

TEST(FewReadings, OfSeveralFormsTheWorstIsReportedByName) {
  std::vector<Profile> lines;
  std::vector<DeclaredEffect> effects;
  for (const double bow : {0.2e-3, 1.9e-3, 1.0e-3}) {
    const std::string name = "line" + std::to_string(lines.size());
    RandomStream random(lines.size(), "forms");
    std::vector<double> heights;
    for (int k = 0; k < 41; ++k)
      heights.push_back(bow * 4.0 * k / 40.0 * (1.0 - k / 40.0) + 2e-5 * random.normal());
    lines.push_back(
        cases::profile(name, Kind::slide, cases::spaced(0.0, 400.0, 41), std::move(heights)));
    effects.push_back(cases::effect("straightness", 3));
    effects.back().options.profiles = {name};
  }
  Problem problem = cases::problem(Lever::paper, 0, effects);
  problem.tolerance = Tolerance{.straightness_um = 1.5};
  const Result result = identify(problem, lines, Scope::fit);
  const Straightness& form = *result.final->straightness;
  EXPECT_EQ(form.profiles, std::vector<std::string>{"line1"});
  EXPECT_TRUE(holds(form, 1.9));
  ASSERT_EQ(form.each.size(), 3U);
  EXPECT_NEAR(*form.each[0].end_point_um, 0.2, *form.each[0].expanded_uncertainty_um);
  EXPECT_NEAR(*form.each[2].end_point_um, 1.0, *form.each[2].expanded_uncertainty_um);
}

}  // namespace
}  // namespace slideway
