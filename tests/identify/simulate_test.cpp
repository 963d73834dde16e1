#include "slideway/identify/simulate.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "identify/cases.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/signal/correlation.hpp"

namespace slideway {
namespace {

/// A face of radius 10 mm whose file is not there, and what it is made from.
Problem made_face(std::size_t samples = 20000) {
  Problem problem = cases::problem(Lever::paper, 5,
                                   {cases::effect("straightness", 3), cases::effect("squareness")});
  ProfileEntry entry;
  entry.profile = cases::face("face", 2.0, {0.0, 10.0}, {0.0, 0.0});
  entry.profile.positions.clear();
  entry.profile.values.clear();
  entry.source.path = "no such file.csv";
  problem.profiles = {entry};
  problem.truth.emplace();
  problem.truth->samples = samples;
  return problem;
}

std::vector<double> values(const Problem& problem) { return simulate(problem).front().values; }

TEST(Simulate, GivesTheSameDataForTheSameSeedOnly) {
  Problem problem = made_face(500);
  problem.truth->noise_um = 0.1;
  const std::vector<double> first = values(problem);
  EXPECT_EQ(first, values(problem));
  problem.truth->seed = 2;
  EXPECT_NE(first, values(problem));
}

TEST(Simulate, KeepsTheRadiusOfACutThatWasReadInPart) {
  Problem problem = made_face(11);
  problem.profiles[0].profile.setup.cut_radius_mm = 10.0;
  problem.profiles[0].source.position_unit = "mm";
  problem.profiles[0].source.window = {2.0, 6.0};
  const Profile face = simulate(problem).front();
  EXPECT_EQ(face.positions.back(), 6.0);
  EXPECT_EQ(face.setup.cut_radius_mm, 10.0);
  EXPECT_EQ(face.setup.last_mm, 6.0);
}

TEST(Simulate, NoiseOfAProfileDoesNotDependOnTheOthers) {
  Problem alone = made_face(500);
  alone.truth->noise_um = 0.1;
  Problem among = alone;
  among.profiles.insert(among.profiles.begin(), alone.profiles[0]);
  among.profiles[0].profile.name = "another";
  const std::vector<Profile> both = simulate(among);
  EXPECT_EQ(both[1].values, values(alone));
  EXPECT_NE(both[0].values, both[1].values);
}

TEST(Simulate, FollowsTheModelWithoutNoise) {
  // Eq. (16), one lever: -Δβ r + Σ (1 - k) b_k r^k, and a hidden cup A (r/R)².
  Problem problem = made_face(101);
  problem.truth->parameters = {{"squareness.dbeta_xz", 2e-5}, {"straightness.b2", 3e-8}};
  problem.truth->effects = {{"cup", {}, {{"sag_um", 0.2}}}};
  const Profile face = simulate(problem).front();
  ASSERT_EQ(face.positions.size(), 101u);
  EXPECT_EQ(face.positions.front(), 0.0);
  EXPECT_EQ(face.positions.back(), 10.0);
  for (std::size_t i = 0; i < face.positions.size(); ++i) {
    const double r = face.positions[i];
    // A rounding of the 2e-4 mm there are.
    EXPECT_NEAR(face.values[i], -2e-5 * r - 3e-8 * r * r + 2e-4 * r * r / 100.0, 1e-18);
  }
}

TEST(Simulate, WhiteNoiseHasItsSize) {
  Problem problem = made_face();
  problem.truth->noise_um = 0.1;
  const std::vector<double> noise = values(problem);
  double squares = 0.0;
  for (const double value : noise) squares += value * value;
  // Four standard errors: 1/sqrt(2n) of the standard deviation, 1/sqrt(n) of a correlation.
  const double n = static_cast<double>(noise.size());
  EXPECT_NEAR(std::sqrt(squares / n) / 1e-4, 1.0, 4.0 / std::sqrt(2.0 * n));
  EXPECT_NEAR(autocorrelation(noise, 1)[1], 0.0, 4.0 / std::sqrt(n));
}

TEST(Simulate, CorrelatedNoiseHasItsSizeAndLength) {
  Problem problem = made_face();
  problem.truth->noise_um = 0.1;
  problem.truth->noise_correlation_mm = 0.02;  // 40 samples
  const std::vector<double> noise = values(problem);
  double squares = 0.0;
  for (const double value : noise) squares += value * value;
  const double n = static_cast<double>(noise.size());
  const double kept = std::exp(-1.0 / 40.0);
  // Four standard errors: a variance rests on n (1 - ρ²)/(1 + ρ²) values, ρ_1 has
  // sqrt((1 - ρ²)/n). One sample more or less in 20000 is nothing beside them.
  const double independent = n * (1.0 - kept * kept) / (1.0 + kept * kept);
  EXPECT_NEAR(std::sqrt(squares / n) / 1e-4, 1.0, 4.0 / std::sqrt(2.0 * independent));
  EXPECT_NEAR(autocorrelation(noise, 1)[1], kept, 4.0 * std::sqrt((1.0 - kept * kept) / n));
}

TEST(Simulate, AndFitFindTheTruthAgain) {
  Problem problem = made_face();
  problem.truth->noise_um = 0.002;
  problem.truth->noise_correlation_mm = 0.02;
  problem.truth->parameters = {
      {"squareness.dbeta_xz", 2e-5}, {"straightness.b2", 1e-5}, {"straightness.b3", -5e-7}};
  const std::vector<Profile> profiles = simulate(problem);
  const Model model = build_model(problem, profiles);
  const ModelResult result = summarise(model, fit(model));
  for (const auto& [name, truth] : problem.truth->parameters) {
    const FittedParameter* parameter = result.find(name);
    ASSERT_TRUE(parameter->value) << name;
    // Twice U: about four standard uncertainties.
    EXPECT_NEAR(*parameter->value, truth, 2.0 * *parameter->expanded_uncertainty) << name;
    EXPECT_LT(*parameter->expanded_uncertainty, 0.2 * std::abs(truth)) << name;
  }
}

TEST(Simulate, RefusesWhatItCanNotMake) {
  Problem problem = made_face();
  problem.profiles[0].profile.setup.cut_radius_mm.reset();
  EXPECT_THROW(simulate(problem), UsageError);  // nothing tells the positions
  problem.truth.reset();
  EXPECT_THROW(simulate(problem), UsageError);
  Problem shapeless = made_face();
  shapeless.effects.push_back(cases::effect("thermal_drift"));
  shapeless.truth->parameters = {{"thermal_drift.amplitude_um", 0.4}};
  EXPECT_THROW(simulate(shapeless), UsageError);  // no time constant
}

}  // namespace
}  // namespace slideway
