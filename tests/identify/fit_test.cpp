#include "slideway/identify/fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <fstream>

#include "base/temporary_folder.hpp"
#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/formula.hpp"
#include "support/turning.hpp"

namespace slideway {
namespace {

using Extended = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

constexpr double kSpindle = 30.0;  // mm, slide coordinate of the spindle axis
constexpr double kBase = 20.0;     // mm, of the bridge
const turning::Carriage kCarriage{.b = {0.0, 3e-6, 2e-8, -1e-10}, .squareness = 2e-5};

double face_error(const turning::ToolPoint& tool) { return turning::one_lever(kCarriage, tool); }
double slide_error(const turning::ToolPoint& tool) {
  return turning::polynomial(kCarriage.b, tool.x);
}

Profile with_noise(Profile profile, double uncertainty) {
  profile.standard_uncertainty = uncertainty;
  RandomStream random(1, profile.name);
  for (double& value : profile.values) value += uncertainty * random.normal();
  return profile;
}

/// The same machine as a face shows it and as three instruments read its slide.
std::vector<Profile> readings() {
  RandomStream silent(0, "none");
  turning::Cut cut;
  cut.radius_mm = 60.0;
  cut.feed_mm_per_min = 10.0;
  cut.spindle_rpm = 1000.0;
  cut.spindle_position_mm = kSpindle;
  turning::Stylus stylus;
  stylus.offset_mm = 2e-3;
  const std::vector<double> radii = cases::spaced(0.0, 60.0, 800);
  Profile face = cases::face("face", 10.0, radii,
                             turning::trace(turning::Face(cut, face_error), radii, stylus, silent));
  face.setup.spindle_position_mm = kSpindle;
  turning::Pass pass;
  pass.zero = 1e-5;
  const std::vector<double> travel = cases::spaced(15.0, 95.0, 400);
  Profile height = cases::profile("height", Kind::slide, travel,
                                  turning::slide_heights(slide_error, travel, pass, silent));
  height.free_tilt = false;
  Profile bridge = cases::profile("bridge", Kind::slide, travel,
                                  turning::slide_slopes(slide_error, travel, kBase, pass, silent));
  // Chords as short as 10 µm: the local slope to 2e-15.
  Profile slope = cases::profile("slope", Kind::slide, travel,
                                 turning::slide_slopes(slide_error, travel, 0.01, pass, silent));
  bridge.setup.quantity = slope.setup.quantity = Quantity::slope;
  bridge.setup.base_mm = kBase;
  return {with_noise(face, 2e-5), with_noise(height, 1e-5), with_noise(bridge, 3e-7),
          with_noise(slope, 5e-7)};
}

/// What b_k adds to a reading at one position, from Eqs. (10) and (16).
long double power_in(const Profile& profile, int k, long double s) {
  const auto power = [](long double x, int n) { return n < 0 ? 0.0L : std::pow(x, n); };
  if (profile.setup.kind == Kind::face) {
    const long double x = kSpindle + s;
    return power(x, k) - k * power(x, k - 1) * s;
  }
  if (profile.setup.quantity == Quantity::height) return power(s, k);
  if (!profile.setup.base_mm) return k * power(s, k - 1);
  return (power(s + kBase / 2, k) - power(s - kBase / 2, k)) / kBase;
}

/// b_1, b_2, b_3 and the squareness by QR in extended precision on columns written out here:
/// heights averaged over four samples (db1, level 2), one constant per profile.
Eigen::VectorXd direct_solution(const std::vector<Profile>& profiles) {
  Eigen::Index rows = 0;
  for (const Profile& profile : profiles) rows += std::ssize(profile.values) / 4;
  Extended a = Extended::Zero(rows, 4 + std::ssize(profiles));
  Extended y = Extended::Zero(rows, 1);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const Profile& profile = profiles[i];
    for (std::size_t first = 0; first + 4 <= profile.values.size(); first += 4, ++row) {
      for (std::size_t j = first; j < first + 4; ++j) {
        const long double s = profile.positions[j];
        for (int k = 1; k <= 3; ++k) a(row, k - 1) += power_in(profile, k, s);
        if (profile.setup.kind == Kind::face) a(row, 3) -= s;
        a(row, 4 + static_cast<Eigen::Index>(i)) += 1.0L;
        y(row, 0) += profile.values[j];
      }
      a.row(row) /= *profile.standard_uncertainty;
      y.row(row) /= *profile.standard_uncertainty;
    }
  }
  const Extended scale = a.colwise().norm().cwiseInverse();
  const Extended x = scale.transpose().asDiagonal() *
                     (a * scale.row(0).asDiagonal()).colPivHouseholderQr().solve(y);
  return x.col(0).head(4).cast<double>();
}

Problem joint_problem() {
  return cases::problem(Lever::paper, 2,
                        {cases::effect("straightness", 3), cases::effect("squareness")});
}

ModelResult fitted(const Problem& problem, const std::vector<Profile>& profiles) {
  const Model model = build_model(problem, profiles);
  return summarise(model, fit(model));
}

double value(const ModelResult& result, const std::string& name) {
  return result.find(name)->value.value();
}
double uncertainty(const ModelResult& result, const std::string& name) {
  return result.find(name)->standard_uncertainty.value();
}

const std::vector<std::string> kDetermined{"straightness.b1", "straightness.b2", "straightness.b3",
                                           "squareness.dbeta_xz"};

TEST(Fit, OfFourKindsOfReadingsAgreesWithTheDirectSolution) {
  const std::vector<Profile> profiles = readings();
  const ModelResult result = fitted(joint_problem(), profiles);
  const Eigen::VectorXd direct = direct_solution(profiles);
  ASSERT_TRUE(result.converged);
  for (std::size_t p = 0; p < kDetermined.size(); ++p) {
    // Twelve digits are left of the powers of 95 mm in double precision; two are spared.
    EXPECT_NEAR(value(result, kDetermined[p]), direct[p], 1e-10 * std::abs(direct[p]))
        << kDetermined[p];
  }
}

TEST(Fit, OfFourKindsOfReadingsFindsTheMachine) {
  const ModelResult result = fitted(joint_problem(), readings());
  const std::vector<double> truth{3e-6, 2e-8, -1e-10, 2e-5};
  for (std::size_t p = 0; p < kDetermined.size(); ++p) {
    // Four standard uncertainties: 1 in 16000 each, and the seed is fixed.
    EXPECT_NEAR(value(result, kDetermined[p]), truth[p], 4.0 * uncertainty(result, kDetermined[p]))
        << kDetermined[p];
  }
  for (const NoiseSummary& noise : result.noise) EXPECT_EQ(noise.scaling, NoiseScaling::declared);
}

// A face of 100 values 0.1 mm apart; two of them lie 0.05 mm from the axis, within one value.
TEST(Fit, CountsTheValuesThatItUses) {
  const std::vector<double> radii = cases::spaced(-4.95, 4.95, 100);
  std::vector<double> heights;
  for (const double s : radii) heights.push_back(-2e-5 * std::abs(s));
  const std::vector<Profile> profiles{with_noise(cases::face("face", 10.0, radii, heights), 2e-5)};
  const auto [model, found] = fit_model(
      build_model(cases::problem(Lever::paper, 0, {cases::effect("squareness")}), profiles));
  const ModelResult result = summarise(model, found);
  EXPECT_EQ(result.observations, 98U);
  EXPECT_DOUBLE_EQ(result.effective_observations, 98.0);  // declared: white
  EXPECT_DOUBLE_EQ(result.noise[0].effective_observations, 98.0);
}

void expect_same(const ModelResult& a, const ModelResult& b, double factor = 1.0) {
  for (const std::string& name : kDetermined) {
    // Roundings of the data, which a millionth of the uncertainty is far above.
    EXPECT_NEAR(factor * value(a, name), value(b, name), 1e-6 * uncertainty(b, name)) << name;
    EXPECT_NEAR(factor * uncertainty(a, name), uncertainty(b, name), 1e-9 * uncertainty(b, name))
        << name;
  }
}

TEST(Fit, OfAShiftedTraceDiffersInItsOffsetOnly) {
  std::vector<Profile> profiles = readings();
  const ModelResult before = fitted(joint_problem(), profiles);
  for (double& z : profiles[0].values) z += 0.5;
  const ModelResult after = fitted(joint_problem(), profiles);
  expect_same(before, after);
  ASSERT_EQ(after.nuisances[0].name, "face.offset");
  // The offset is 500 µm; its doubles end at 1e-13 of that.
  EXPECT_NEAR(*after.nuisances[0].value - *before.nuisances[0].value, 500.0, 1e-9);
}

// Of a declared noise there is nothing to estimate: the normal distribution, k = 2 at 95.45 %.
TEST(Fit, LevelsUnderADeclaredNoiseWithACoverageFactorOfTwo) {
  const ModelResult result = fitted(joint_problem(), readings());
  ASSERT_FALSE(result.nuisances.empty());
  for (const FittedParameter& nuisance : result.nuisances)
    EXPECT_NEAR(*nuisance.expanded_uncertainty / *nuisance.standard_uncertainty, 2.0, 1e-3)
        << nuisance.name;
}

TEST(Fit, OfATiltedTraceDiffersInItsTiltOnly) {
  std::vector<Profile> profiles = readings();
  profiles[1].free_tilt = true;  // the bridge's zero is free: b_1 goes with the tilt
  const std::vector<std::string> curved{"straightness.b2", "straightness.b3"};
  const ModelResult before = fitted(joint_problem(), profiles);
  for (std::size_t i = 0; i < profiles[1].values.size(); ++i)
    profiles[1].values[i] += 1e-3 * profiles[1].positions[i];
  const ModelResult after = fitted(joint_problem(), profiles);
  for (const std::string& name : curved)
    EXPECT_NEAR(value(after, name), value(before, name), 1e-6 * uncertainty(before, name)) << name;
  ASSERT_EQ(after.nuisances[2].name, "height.tilt");
  EXPECT_NEAR(*after.nuisances[2].value - *before.nuisances[2].value, 1e-3, 1e-12);
}

TEST(Fit, ScalesWithTheData) {
  std::vector<Profile> profiles = readings();
  const ModelResult before = fitted(joint_problem(), profiles);
  for (Profile& profile : profiles) {
    for (double& z : profile.values) z *= 3.0;
    *profile.standard_uncertainty *= 3.0;
  }
  expect_same(before, fitted(joint_problem(), profiles), 3.0);
}

TEST(Fit, OfEveryProfileTwiceHasHalfTheVariance) {
  std::vector<Profile> profiles = readings();
  const ModelResult once = fitted(joint_problem(), profiles);
  const std::size_t count = profiles.size();
  for (std::size_t i = 0; i < count; ++i) {
    profiles.push_back(profiles[i]);
    profiles.back().name += " again";
  }
  const ModelResult twice = fitted(joint_problem(), profiles);
  for (const std::string& name : kDetermined) {
    EXPECT_NEAR(value(once, name), value(twice, name), 1e-6 * uncertainty(once, name)) << name;
    EXPECT_NEAR(uncertainty(once, name) / uncertainty(twice, name), std::sqrt(2.0), 1e-9) << name;
  }
}

TEST(Fit, DoesNotMindTheOrderOfAFileNorItsUnits) {
  const TemporaryFolder folder;
  const std::vector<Profile> profiles = readings();
  const auto from_file = [&](const std::string& name, bool backwards, double unit,
                             std::string_view unit_name) {
    std::ofstream out(folder.path() / name);
    const Profile& face = profiles[0];
    for (std::size_t i = 0; i < face.values.size(); ++i) {
      const std::size_t j = backwards ? face.values.size() - 1 - i : i;
      out << shortest(face.positions[j]) << ',' << shortest(face.values[j] * unit) << '\n';
    }
    out.close();
    std::vector<Profile> read = profiles;
    ProfileSource source;
    source.path = folder.path() / name;
    source.position_unit = "mm";
    source.value_unit = unit_name;
    read_profile(source, read[0]);
    return fitted(joint_problem(), read);
  };
  const ModelResult forwards = from_file("forwards.csv", false, 1.0, "mm");
  const ModelResult backwards = from_file("backwards.csv", true, 1.0, "mm");
  for (const std::string& name : kDetermined)
    EXPECT_EQ(value(forwards, name), value(backwards, name)) << name;
  expect_same(forwards, from_file("micrometres.csv", false, 1e3, "um"));
}

TEST(Fit, OfPositionsThatAreNotUniformIsUnbiased) {
  std::vector<double> positions = cases::spaced(0.0, 80.0, 2000);
  RandomStream random(3, "positions");
  for (double& position : positions) position += 0.01 * random.uniform();  // steps of 0.04
  std::vector<double> heights;
  for (const double x : positions) heights.push_back(turning::polynomial(kCarriage.b, x));
  Profile slide = cases::profile("slide", Kind::slide, positions, heights);
  slide.free_offset = slide.free_tilt = false;
  const ModelResult result =
      fitted(cases::problem(Lever::paper, 5, {cases::effect("straightness", 3)}), {slide});
  // Data and columns are interpolated alike: what is left is rounding, 1e-10 of b_1's and b_3's
  // size.
  for (int k = 1; k <= 3; ++k)
    EXPECT_NEAR(value(result, "straightness.b" + std::to_string(k)), kCarriage.b[k],
                1e-10 * std::abs(kCarriage.b[k]))
        << k;
}

// GUM G.4.2: of a type B evaluation taken as exactly known they are infinitely many.
TEST(Fit, OfWhatAPriorAloneTellsHasNoDegreesOfFreedom) {
  RandomStream random(12, "prior");
  Profile face = cases::face("face", 2.0, cases::spaced(-10.0, 10.0, 2000), {});
  for (const double x : face.positions)
    face.values.push_back(1e-6 * x * x + 1e-4 * random.normal());
  face.free_tilt = true;
  DeclaredEffect straightness = cases::effect("straightness", 2);
  straightness.priors = {{"b0", 2.41e-4, 2.9e-7}, {"b1", -5.19e-7, 2.9e-10}};
  const ModelResult result = fitted(cases::problem(Lever::split, 0, {straightness}), {face});
  for (const char* name : {"straightness.b0", "straightness.b1"}) {
    EXPECT_EQ(result.find(name)->degrees_of_freedom, std::nullopt) << name;
    EXPECT_EQ(result.find(name)->coverage_factor, 2.0) << name;
  }
  EXPECT_NE(result.find("straightness.b2")->degrees_of_freedom, std::nullopt);
}

TEST(Fit, FindsTheTimeConstantOfADriftFromTwoFeeds) {
  constexpr double kAmplitude = 0.4, kTimeConstant = 240.0;  // µm, s
  const auto error = [&](const turning::ToolPoint& tool) {
    return turning::one_lever(kCarriage, tool) +
           1e-3 * kAmplitude * (1.0 - std::exp(-tool.t / kTimeConstant));
  };
  RandomStream random(11, "two feeds");
  const std::vector<double> radii = cases::spaced(0.0, 50.0, 4000);
  std::vector<Profile> profiles;
  for (const double feed : {2.0, 8.0}) {
    turning::Cut cut;
    cut.radius_mm = 50.0;
    cut.feed_mm_per_min = feed;
    cut.spindle_rpm = 500.0;
    turning::Stylus stylus;
    stylus.noise.correlated = 2e-5;
    stylus.noise.correlation_mm = 0.3;
    profiles.push_back(
        cases::face("feed" + std::to_string(static_cast<int>(feed)), feed, radii,
                    turning::trace(turning::Face(cut, error), radii, stylus, random)));
    profiles.back().setup.spindle_rpm = 500.0;
  }
  const ModelResult result =
      fitted(cases::problem(Lever::paper, 5,
                            {cases::effect("straightness", 3), cases::effect("squareness"),
                             cases::effect("thermal_drift")}),
             profiles);
  ASSERT_TRUE(result.converged);
  // Four standard uncertainties, which also make sense of the numbers: 5 % at most.
  const double found = value(result, "thermal_drift.time_constant_s");
  const double u = uncertainty(result, "thermal_drift.time_constant_s");
  EXPECT_NEAR(found, kTimeConstant, 4.0 * u);
  EXPECT_LT(u, 0.05 * kTimeConstant);
  EXPECT_NEAR(value(result, "thermal_drift.amplitude_um"), kAmplitude,
              4.0 * uncertainty(result, "thermal_drift.amplitude_um"));
  EXPECT_NEAR(value(result, "squareness.dbeta_xz"), kCarriage.squareness,
              4.0 * uncertainty(result, "squareness.dbeta_xz"));
}

// What is at a bound is a constant: the rest is the best fit beside that constant.
TEST(Fit, IsTheBestOneBesideAShapeAtItsBound) {
  RandomStream random(3, "bump");
  const std::vector<double> x = cases::spaced(0.0, 400.0, 200);
  std::vector<double> z;
  for (const double at : x)
    z.push_back(5e-3 * std::exp(-std::pow((at - 85.0) / 40.0, 2)) + 1e-4 * random.normal());
  const Profile profile = cases::profile("slide", Kind::slide, x, z);
  const auto fit_of = [&](const std::string& text, std::vector<FormulaParameter> parameters) {
    DeclaredEffect own = cases::effect("own");
    own.options.own =
        formula_effect({.name = "own", .text = text, .parameters = std::move(parameters)});
    return fitted(cases::problem(Lever::paper, 0, {own}), {profile});
  };
  const FormulaParameter size{"a", "um", {}, {}}, width{"w", "mm", 5.0, 100.0};
  const FormulaParameter place{"c", "mm", 100.0, 200.0};  // the bump lies at 85 mm
  const ModelResult bounded = fit_of("a * exp(-((x - c) / w)^2)", {size, place, width});
  const ModelResult held = fit_of("a * exp(-((x - 100) / w)^2)", {size, width});
  ASSERT_EQ(value(bounded, "own.c"), 100.0);
  // A hundredth of a standard uncertainty is what nobody sees.
  for (const char* name : {"own.a", "own.w"})
    EXPECT_NEAR(value(bounded, name), value(held, name), 0.01 * uncertainty(held, name)) << name;
}

/// A bump at 100 mm under noise, and its mirror image at 300 mm or none.
ModelResult fit_of_bump(const DeclaredEffect& effect, bool is_mirrored, std::uint64_t seed) {
  RandomStream random(seed, "bumps");
  const std::vector<double> x = cases::spaced(0.0, 400.0, 100);
  std::vector<double> z;
  for (const double at : x)
    z.push_back(2e-4 * std::exp(-std::pow((at - 100.0) / 30.0, 2)) + 1e-4 * random.normal());
  for (std::size_t i = 0; i < z.size() / 2 && is_mirrored; ++i) z[z.size() - 1 - i] = z[i];
  const std::vector<Profile> profiles{cases::profile("slide", Kind::slide, x, z)};
  const FittedModel found = fit_declared(cases::problem(Lever::paper, 0, {effect}), profiles);
  return summarise(found.model, found.fit);
}

// A reading that is its own mirror image has two bumps, and the model one: either place fits as
// well, and a U from the slope of the model at one of them knows nothing of the other. Of one bump
// no place fits but its own: U is that of the linearised model, 10 to 20 mm.
TEST(Fit, ReachesAllPlacesOfAShapeThatTheDataAllow) {
  const DeclaredEffect form = cases::effect("local_form");
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const ModelResult two = fit_of_bump(form, true, seed);
    const double found = value(two, "local_form.position_mm");
    EXPECT_GT(2.0 * uncertainty(two, "local_form.position_mm"), std::abs(400.0 - 2.0 * found));
    EXPECT_THAT(two.notes, ::testing::Contains(::testing::HasSubstr("every U reaches as far")));
    EXPECT_LT(2.0 * uncertainty(fit_of_bump(form, false, seed), "local_form.position_mm"), 50.0);
  }
}

// Published regressions have the uncertainties of their linear model.
TEST(Fit, SaysOfAFormulaWhichOtherPlaceFits) {
  DeclaredEffect own = cases::effect("own");
  own.options.own = formula_effect({.name = "own",
                                    .text = "a * exp(-((x - c) / 30)^2)",
                                    .parameters = {{"a", "um", {}, {}}, {"c", "mm", 20.0, 380.0}}});
  const ModelResult two = fit_of_bump(own, true, 1);
  EXPECT_LT(2.0 * uncertainty(two, "own.c"), 50.0);
  EXPECT_THAT(two.notes, ::testing::Contains(::testing::HasSubstr("does not reach it")));
}

}  // namespace
}  // namespace slideway
