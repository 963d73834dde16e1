// What leaves the fit nothing to know a number by: it is said to be not determined, or it has an
// uncertainty above 0. Found by the fuzz target `identify` and by drawn problems.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "face_slope.hpp"
#include "identify/cases.hpp"
#include "noise_bounds.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/lack_of_fit.hpp"

namespace slideway::degenerate_test {
namespace {

using cases::effect;
using cases::face;
using cases::problem;
using cases::profile;
using cases::spaced;

std::vector<double> rough(std::size_t n, double size) {
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i)
    out.push_back(size * std::sin(997.0 * static_cast<double>(i * i)));
  return out;
}

// A wave that no fitted profile can see: its columns are zero, and so is its amplitude.
TEST(Degenerate, AWaveThatNoProfileSeesIsNotDetermined) {
  Profile slope = profile("level", Kind::slide, spaced(0, 400, 60), rough(60, 1e-6));
  slope.setup.quantity = Quantity::slope;
  slope.setup.traverse_mm_per_s = 1.0;
  const Result result =
      identify(problem(Lever::paper, 0, {effect("traverse_periodic")}), {slope}, Scope::fit);
  for (const char* name : {"amplitude_um", "frequency_hz", "phase_rad"})
    EXPECT_FALSE(result.declared->find("traverse_periodic." + std::string(name))->identifiable)
        << name;
  for (const UndeterminedDirection& direction : result.declared->identifiability.unidentifiable)
    EXPECT_FALSE(direction.combination.empty());
}

// A flat line has a wave of amplitude 0, which is known to be small; its phase is anything.
TEST(Degenerate, AWaveOfNoAmplitudeHasAnUncertaintyAndNoPhase) {
  Profile flat = profile("flat", Kind::slide, spaced(0, 400, 60), std::vector<double>(60, 0.0));
  flat.free_offset = flat.free_tilt = false;
  flat.standard_uncertainty = 1e-5;
  const Result result =
      identify(problem(Lever::paper, 0, {effect("slide_periodic")}), {flat}, Scope::fit);
  const FittedParameter& amplitude = *result.declared->find("slide_periodic.amplitude_um");
  ASSERT_TRUE(amplitude.identifiable);
  EXPECT_EQ(*amplitude.value, 0.0);
  EXPECT_GT(*amplitude.expanded_uncertainty, 0.0);
  EXPECT_FALSE(result.declared->find("slide_periodic.phase_rad")->identifiable);
}

TEST(Degenerate, AStraightnessOfDegree1HasNoDeviation) {
  const Profile slide = profile("slide", Kind::slide, spaced(0, 400, 60), rough(60, 1e-4));
  const Result result =
      identify(problem(Lever::paper, 0, {effect("straightness", 1)}), {slide}, Scope::fit);
  ASSERT_TRUE(result.declared->straightness);
  EXPECT_FALSE(result.declared->straightness->reason.empty());
  EXPECT_TRUE(result.declared->straightness->errors.empty());
}

// Two readings are one low-band value, which shows no tilt.
TEST(Degenerate, ATiltThatTheLowBandDoesNotShowIsNotDetermined) {
  const Profile a = profile("a", Kind::slide, spaced(0, 400, 60), rough(60, 1e-4));
  const Profile b = profile("b", Kind::slide, spaced(0, 400, 2), rough(2, 1e-4));
  const Result result =
      identify(problem(Lever::paper, 1, {effect("straightness", 2)}), {a, b}, Scope::fit);
  const auto tilt = std::ranges::find(result.declared->nuisances, "b.tilt", &FittedParameter::name);
  ASSERT_NE(tilt, result.declared->nuisances.end());
  EXPECT_FALSE(tilt->identifiable);
  EXPECT_FALSE(tilt->value || tilt->expanded_uncertainty);
}

TEST(Degenerate, NoiseLiesBetweenRoundingAndRangeOfItsValues) {
  Profile profile;
  const Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(20, 1.0, 3.0);
  const auto size = [&](double deviation) {
    return bounded(Noise::white(deviation, 20), profile, values).standard_deviation();
  };
  EXPECT_EQ(size(0.1), 0.1);
  EXPECT_NEAR(size(1e125), 2.0, 1e-12);       // the range; 1e-12: rounding of a factor of 1e-250
  EXPECT_NEAR(size(1e-140), 2.1e-13, 1e-14);  // 1e-13 of the root mean square, 2.08
  EXPECT_NEAR(size(std::nan("")), 2.1e-13, 1e-14);
  profile.resolution = 0.06;
  EXPECT_DOUBLE_EQ(size(1e-140), 0.06 / std::sqrt(12.0));  // GUM F.2.2.1
  profile.resolution = 0.0;
  EXPECT_GT(bounded(Noise::white(0.0, 3), profile, Eigen::Vector3d::Zero()).standard_deviation(),
            0.0);
}

TEST(Degenerate, ValuesThatAreTheModelsOwnAreToldAsSuch) {
  const auto notes = [](std::vector<double> values, double resolution) {
    Profile slide = profile("slide", Kind::slide, spaced(0, 400, 64), std::move(values));
    slide.resolution = resolution;
    return identify(problem(Lever::paper, 0, {effect("straightness", 2)}), {slide}, Scope::fit)
        .declared->notes;
  };
  const auto tells = [](const std::vector<std::string>& notes) {
    return std::ranges::any_of(notes, [](const std::string& note) {
      return note.find("passes through its values") != std::string::npos;
    });
  };
  std::vector<double> parabola;
  for (const double x : spaced(0, 400, 64)) parabola.push_back(1e-8 * x * x);
  EXPECT_TRUE(tells(notes(parabola, 0.0)));
  EXPECT_FALSE(tells(notes(parabola, 1e-6)));  // coarse readings: U holds their rounding
  EXPECT_FALSE(tells(notes(rough(64, 1e-4), 0.0)));
}

/// A face, and slopes along a slide of so many stations, each with a noise of its own.
struct FaceBesideSlopes {
  explicit FaceBesideSlopes(int stations)
      : profiles{face("a", 8.0, spaced(1, 40, 80), rough(80, 1e-4)),
                 profile("b", Kind::slide, spaced(0, 400, stations), rough(stations, 1e-6))} {
    profiles[1].setup.quantity = Quantity::slope;
    fitted = fit_declared(problem(Lever::paper, 0, {effect("squareness")}), profiles);
  }

  std::vector<Profile> profiles;
  std::optional<FittedModel> fitted;
};

// Three values have no slow cosine of their own, and nothing may be known of the size of their
// noise; the others are judged without them.
TEST(Degenerate, LackOfFitPassesOverAProfileTooShortToJudge) {
  const FaceBesideSlopes cut(3);
  const Solution& fit = cut.fitted->fit;
  std::vector<Noise> noise = fit.noise;
  ASSERT_TRUE(noise[1].is_estimated());
  noise[1].freedom = 0.0;
  const LackOfFit left = lack_of_fit(fit.linear, noise, {});
  EXPECT_TRUE(left.p_value >= 0.0 && left.p_value <= 1.0) << left.p_value;
  EXPECT_TRUE(std::isfinite(left.ratio)) << left.ratio;
}

// Probabilities of a pool add up to 1 but for rounding.
TEST(Degenerate, LackOfFitEndsWhereProbabilitiesAddUpToLessThanOne) {
  const FaceBesideSlopes cut(80);
  const Solution& fit = cut.fitted->fit;
  std::vector<Noise> noise = fit.noise;
  ASSERT_NE(noise[0].pool, noise[1].pool);
  for (Noise& each : noise)
    each.alternatives = {{0.5, each.covariance()}, {0.5, each.covariance()}};
  const LackOfFit exact = lack_of_fit(fit.linear, noise, {});
  noise[0].alternatives.back().probability -= 2e-12;
  noise[1].alternatives.back().probability -= 1e-12;
  noise[1].alternatives.push_back({1e-12, noise[1].covariance()});
  EXPECT_NEAR(lack_of_fit(fit.linear, noise, {}).p_value, exact.p_value, 1e-11);
}

// A wave of a period as near zero as one likes passes through values at any places. Two values a
// cycle tell it from its alias; each of these is noise alone.
TEST(Degenerate, AWaveInNoiseIsNoAliasOfTheStations) {
  constexpr double kSpacing = 400.0 / 59.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RandomStream random(seed, "noise");
    std::vector<double> z;
    for (int i = 0; i < 60; ++i) z.push_back(4e-4 * random.normal());
    const std::vector<Profile> profiles{profile("slide", Kind::slide, spaced(0, 400, 60), z)};
    DeclaredEffect wave = effect("slide_periodic");
    wave.priors = {{"amplitude_um", 0.0, 0.1}};
    const Result result = identify(problem(Lever::paper, 0, {wave}), profiles, Scope::fit);
    for (const FittedParameter& each : result.declared->parameters) {
      ASSERT_TRUE(each.value) << each.name;
      EXPECT_GT(*each.expanded_uncertainty, 0.0) << each.name;
    }
    EXPECT_GE(*result.declared->find("slide_periodic.period_mm")->value, 1.99 * kSpacing) << seed;
  }
}

// A parameter that changes no value, and that both profiles have from one prior, cannot differ.
TEST(Degenerate, WhatProfilesHaveFromAPriorAloneIsNotCompared) {
  DeclaredEffect zero = effect("instrument_zero");
  zero.priors = {{"zero", 1.0, 0.5}};
  const std::vector<Profile> profiles{
      profile("a", Kind::slide, spaced(0, 400, 60), rough(60, 1e-4)),
      profile("b", Kind::slide, spaced(0, 400, 50), rough(50, 1e-4))};
  const Result result = identify(problem(Lever::paper, 0, {zero, effect("straightness", 3)}),
                                 profiles, Scope::identify);
  std::vector<std::string> compared;
  for (const ProfileCheck& check : result.crosscheck.profiles) {
    compared.push_back(check.what);
    EXPECT_TRUE(check.En && std::isfinite(*check.En)) << check.what;
  }
  EXPECT_THAT(compared, ::testing::ElementsAre("straightness"));
}

// Huber's ψ rises nowhere where every value lies beyond its corner.
TEST(Degenerate, ALossThatLeavesNoValueWholeHasAFiniteResidual) {
  Profile face_a = face("a", 8.0, spaced(1, 40, 40), rough(40, 1.0));
  face_a.loss = Loss::huber;
  face_a.standard_uncertainty = 1e-6;  // of values a million times as far apart
  const std::vector<Profile> profiles{face_a};
  const Result result =
      identify(problem(Lever::paper, 0, {effect("squareness")}), profiles, Scope::fit);
  EXPECT_TRUE(std::isfinite(result.declared->chi_square));
  EXPECT_TRUE(result.declared->rms_um && std::isfinite(*result.declared->rms_um));
}

// The root of the mean square of nothing has no derivative: U of a height off centre was no number.
TEST(Degenerate, TheSlopeOfAFlatFaceGrowsAlikeInEveryDirection) {
  const std::vector<Profile> profiles{face("a", 8.0, spaced(-40, 40, 80), rough(80, 1e-4))};
  const Model model =
      build_model(problem(Lever::paper, 0, {effect("squareness"), effect("centring")}), profiles);
  EXPECT_TRUE(rms_slope_by_amplitude(model, initial_estimate(model)).isZero());
}

// A roll-off of a rim that the trace does not reach falls by e for each of its widths: it is there
// to 1e-160, whose square is no number. It had an amplitude of 1e165 µm, and U was no number.
TEST(Degenerate, AnEffectThatIsFarBelowWhatASquareHoldsIsNotDetermined) {
  Profile face_a = face("a", 8.0, spaced(0, 200, 60), rough(60, 1e-4));
  face_a.setup.cut_radius_mm = 600.0;
  const std::vector<Profile> profiles{face_a};
  const Model model = build_model(problem(Lever::paper, 0, {effect("edge_roll_off")}), profiles);
  Estimate estimate = initial_estimate(model);
  estimate.shapes[0] = 1.0;
  const Eigen::MatrixXd columns = linear_columns(model, estimate, model.observations[0]);
  EXPECT_TRUE(columns.leftCols(model.amplitudes()).isZero(0.0));
}

}  // namespace
}  // namespace slideway::degenerate_test
