// Straightness as a curve, on ways that are no polynomial. The ways are made by rules of their own:
// a slope along the slide, summed to a height; no spline and no process of the program.

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

/// Slope of a way of length 1 and a size of 1, from its own random stream.
using Slope = std::function<double(double u)>;
using MakeSlope = std::function<Slope(RandomStream&)>;

Slope kinked(RandomStream& random) {
  return [at = 0.25 + 0.5 * random.uniform()](double u) { return u > at ? 4.0 : 0.0; };
}

Slope jointed(RandomStream& random) {
  const double at = 0.25 + 0.5 * random.uniform(), width = 0.01 + 0.02 * random.uniform();
  return [=](double u) { return 0.5 / width * std::exp(-0.5 * std::pow((u - at) / width, 2)); };
}

Slope dipped(RandomStream& random) {
  const double at = 0.25 + 0.5 * random.uniform(), width = 0.05 + 0.1 * random.uniform();
  return [=](double u) {
    return (u - at) / (width * width) * std::exp(-0.5 * std::pow((u - at) / width, 2));
  };
}

Slope worn(RandomStream& random) {
  const double from = 0.2 + 0.3 * random.uniform(), width = 0.015 + 0.03 * random.uniform();
  const auto edge = [=](double u, double at) { return std::pow(std::cosh((u - at) / width), -2); };
  return [=](double u) { return 0.5 / width * (edge(u, from + 0.25) - edge(u, from)); };
}

Slope wavy(RandomStream& random) {
  const double waves = 2.0 + 3.0 * random.uniform(), phase = 2.0 * kPi * random.uniform();
  return [=](double u) {
    return (1.0 + u) * 2.0 * kPi * waves * std::cos(2.0 * kPi * waves * u + phase);
  };
}

/// A slope that walks, in a thousand steps.
Slope wandering(RandomStream& random) {
  std::vector<double> walk{0.0};
  for (int i = 0; i < 1000; ++i)
    walk.push_back(walk.back() + 2.0 * random.normal() / std::sqrt(1e3));
  return [walk](double u) { return walk[static_cast<std::size_t>(std::lround(u * 1000.0))]; };
}

constexpr int kSteps = 4000;
constexpr double kCurveNoise = 40e-6;  // mm

/// Three diameters of a face of 60 to 240 mm radius, turned on such a way of about 1 µm.
struct WayCase {
  std::vector<Profile> faces;
  double squareness = 0.0;

  WayCase(const MakeSlope& make, std::uint64_t seed) {
    RandomStream random(seed, "way");
    const double R = 60.0 + 180.0 * random.uniform(), size = 1e-3 * (0.5 + random.uniform());
    const Slope way = make(random);
    const double bend = 2e-3 * random.normal(), twist = 3e-3 * random.normal();
    squareness = 2e-5 * random.normal();
    std::vector<double> slope, height{0.0};
    for (int i = 0; i <= kSteps; ++i) {
      const double u = static_cast<double>(i) / kSteps;
      slope.push_back((size * way(u) + bend * u + twist * u * u) / R);
      if (i > 0) height.push_back(height.back() + 0.5 * (slope[i - 1] + slope[i]) * R / kSteps);
    }
    const std::vector<double> X = cases::spaced(-R, R, 1024);
    for (const double feed : {20.0, 50.0, 30.0}) {
      std::vector<double> z;
      double texture = random.normal();
      for (const double each : X) {
        const double r = std::abs(each);
        const auto i = static_cast<std::size_t>(std::lround(r / R * kSteps));
        texture = 0.7 * texture + std::sqrt(0.51) * random.normal();
        z.push_back(height[i] - r * slope[i] - squareness * r +
                    kCurveNoise * std::sqrt(0.5) * (texture + random.normal()));
      }
      Profile& face =
          faces.emplace_back(cases::face("feed" + std::to_string(faces.size()), feed, X, z));
      face.free_tilt = true;
    }
  }
};

DeclaredEffect curve(std::optional<double> resolution_mm = std::nullopt) {
  DeclaredEffect out = cases::effect("straightness");
  out.options.form = Form::curve;
  out.options.resolution_mm = resolution_mm;
  return out;
}

const FittedParameter& squareness_of(const FittedModel& fitted, ModelResult& summary) {
  summary = summarise(fitted.model, fitted.fit);
  return *summary.find("squareness.dbeta_xz");
}

// Two sections of a bed stand 45 µm apart at a joint between two feet of a level. A curve through
// the stations overshoots there, and no reading shows how the way gets from one to the other.
TEST(Curve, HoldsTheFormBetweenStationsWithinItsU) {
  constexpr double kBase = 50.0, kTravel = 2000.0;
  for (const double joint : {1470.0, 820.0})
    for (const std::uint64_t seed : {1, 2, 3}) {
      const auto way = [&](double x) {
        return 22.5e-3 * std::tanh((x - joint) / 5.0) - 4e-8 * x * (x - kTravel);
      };
      std::vector<Profile> runs;
      for (const char* name : {"run1", "run2", "run3"}) {
        RandomStream noise(seed, name);
        std::vector<double> x, slopes;
        for (double at = 0.0; at < kTravel; at += kBase) {
          x.push_back(at + 0.5 * kBase);
          slopes.push_back((way(at + kBase) - way(at)) / kBase + 1.5e-6 * noise.normal());
        }
        Profile& run = runs.emplace_back(cases::profile(name, Kind::slide, x, slopes));
        run.setup.quantity = Quantity::slope;
        run.setup.base_mm = kBase;
      }
      const FittedModel fitted =
          fit_declared(cases::problem(Lever::paper, 0, {curve(kBase)}), runs);
      const Straightness found = summarise(fitted.model, fitted.fit).straightness.value();
      double low = 0.0, high = 0.0;
      for (double x = 0.0; x <= kTravel; x += 1.0) {
        const double z = way(x) - std::lerp(way(0.0), way(kTravel), x / kTravel);
        low = std::min(low, z);
        high = std::max(high, z);
      }
      EXPECT_NEAR(*found.end_point_um, (high - low) / kMicrometre, *found.expanded_uncertainty_um)
          << joint << " " << seed;
      EXPECT_LT(*found.expanded_uncertainty_um, 10.0);
    }
}

class Ways : public testing::TestWithParam<std::pair<const char*, Slope (*)(RandomStream&)>> {};

// Δβxz within U in 92 % of the cases: of ten, fewer than seven have a probability of 0.6 %.
TEST_P(Ways, SquarenessFromACurveLiesWithinItsU) {
  int within = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const WayCase way(GetParam().second, seed);
    const Problem problem = cases::problem(Lever::paper, 3, {cases::effect("squareness"), curve()});
    ModelResult summary;
    const FittedParameter& found = squareness_of(fit_declared(problem, way.faces), summary);
    ASSERT_TRUE(found.value && found.expanded_uncertainty);
    within += std::abs(*found.value - way.squareness) <= *found.expanded_uncertainty;
  }
  EXPECT_GE(within, 7);
}

// The same with a cubic: it is refuted, or its U holds.
TEST_P(Ways, CubicIsRefutedAndItsUWidenedWhereItDoesNotHold) {
  int within = 0;
  for (std::uint64_t seed = 11; seed <= 20; ++seed) {
    const WayCase way(GetParam().second, seed);
    const Problem problem = cases::problem(
        Lever::paper, 3, {cases::effect("squareness"), cases::effect("straightness", 3)});
    ModelResult summary;
    const FittedParameter& found = squareness_of(fit_declared(problem, way.faces), summary);
    ASSERT_TRUE(found.value && found.expanded_uncertainty);
    within += std::abs(*found.value - way.squareness) <= *found.expanded_uncertainty;
  }
  EXPECT_GE(within, 8);
}

INSTANTIATE_TEST_SUITE_P(Of, Ways,
                         testing::Values(std::pair{"Kink", &kinked}, std::pair{"Joint", &jointed},
                                         std::pair{"Dip", &dipped}, std::pair{"Wear", &worn},
                                         std::pair{"Wave", &wavy},
                                         std::pair{"RandomWalk", &wandering}),
                         [](const auto& way) { return way.param.first; });

/// Two readings along 200 mm of a slide that is kinked by 20 µrad at 120 mm, with noise of 20 nm.
std::vector<Profile> kinked_slide() {
  std::vector<Profile> runs;
  for (const char* name : {"first", "second"}) {
    RandomStream noise(3, name);
    const std::vector<double> x = cases::spaced(0.0, 200.0, 401);
    std::vector<double> z;
    for (const double each : x)
      z.push_back(20e-6 * std::max(each - 120.0, 0.0) + 20e-6 * noise.normal());
    runs.push_back(cases::profile(name, Kind::slide, x, z));
  }
  return runs;
}

// The end-point line of a kink: at the kink 120 mm * 80 mm / 200 mm * 20 µrad = 0.96 µm below it.
TEST(Curve, StraightnessOfAKinkHasItsSizeAndPlaceWithinU) {
  const std::vector<Profile> runs = kinked_slide();
  const Problem problem = cases::problem(Lever::paper, 0, {curve()});
  const FittedModel fitted = fit_declared(problem, runs);
  const ModelResult summary = summarise(fitted.model, fitted.fit);
  ASSERT_TRUE(summary.straightness && summary.straightness->form);
  const StraightnessError& error = summary.straightness->errors.front();
  // A piece of 2.5 mm rounds the kink by 20 µrad * 2.5 mm / 4.
  EXPECT_NEAR(*error.value, 0.96, *error.expanded_uncertainty + 0.0125);
  EXPECT_LT(*error.expanded_uncertainty, 0.05);  // 20 nm, 800 readings
  EXPECT_NEAR(error.lowest_at_mm, 120.0, 5.0);   // two pieces
  EXPECT_TRUE(fitted.fit.other_forms.empty());
}

/// Three readings of a slide that bows by 0.8 µm about its middle and is cut short at `at`, where
/// its slope changes by 5 µrad.
std::vector<Profile> cut_short(double at, std::uint64_t seed) {
  std::vector<Profile> runs;
  for (const char* name : {"first", "second", "third"}) {
    RandomStream noise(seed, name);
    const std::vector<double> x = cases::spaced(0.0, 400.0, 201);
    std::vector<double> z;
    for (const double each : x)
      z.push_back(0.8e-3 * std::pow(each / 200.0 - 1.0, 2) + 5e-6 * std::max(each - at, 0.0) +
                  20e-6 * noise.normal());
    runs.push_back(cases::profile(name, Kind::slide, x, z));
  }
  return runs;
}

/// Of that way from its end-point line, µm.
double largest_deviation(double at) {
  double out = 0.0;
  for (double x = 0.0; x <= 400.0; x += 0.5) {
    const double line = 0.8 + 5e-3 * (400.0 - at) * x / 400.0;
    out = std::max(out, line - 0.8 * std::pow(x / 200.0 - 1.0, 2) - 5e-3 * std::max(x - at, 0.0));
  }
  return out;
}

// Below the end-point line by 5e-6 (400 - at) at / 400 of the kink and the parabola there, or more
// beside it. Of 20 readings U of 95 % holds 17 with a probability of 98 %; every piece of 8 mm
// rounds a kink by no more than 5 µrad * 8 mm / 4.
TEST(Curve, UHoldsTheLargestDeviationOfAWayCutShort) {
  const Problem problem = cases::problem(Lever::paper, 0, {curve(8.0)});
  int held = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    RandomStream random(seed, "place");
    const double at = 150.0 + 100.0 * random.uniform();
    const double truth = largest_deviation(at);
    const std::vector<Profile> runs = cut_short(at, seed);
    const FittedModel fitted = fit_declared(problem, runs);
    const ModelResult summary = summarise(fitted.model, fitted.fit);
    const StraightnessError& error = summary.straightness->errors.front();
    held += std::abs(*error.value - truth) <= *error.expanded_uncertainty + 0.01 ? 1 : 0;
    EXPECT_LT(*error.expanded_uncertainty, 0.05);  // 20 nm, 603 readings
  }
  EXPECT_GE(held, 17);
}

/// Six readings of a slide whose slope changes by 30 µrad at 300 mm and by -50 µrad at 700 mm, its
/// largest deviation 9.6 µm.
std::vector<Profile> twice_kinked(std::uint64_t seed) {
  std::vector<Profile> runs;
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
    RandomStream noise(seed, name);
    const std::vector<double> x = cases::spaced(0.0, 1000.0, 400);
    std::vector<double> z;
    for (const double each : x)
      z.push_back(30e-6 * std::max(each - 300.0, 0.0) - 50e-6 * std::max(each - 700.0, 0.0) +
                  300e-6 * noise.normal());
    runs.push_back(cases::profile(name, Kind::slide, x, z));
  }
  return runs;
}

// One kink explains little without the other. Of six draws U of 95 % holds at least four with a
// probability of 99.8 %; a piece of 20 mm has its knots where the kinks are.
TEST(Curve, UHoldsTheLargestDeviationBesideTwoKinks) {
  const Problem problem = cases::problem(Lever::paper, 0, {curve(20.0)});
  int held = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const std::vector<Profile> runs = twice_kinked(seed);
    const FittedModel fitted = fit_declared(problem, runs);
    const ModelResult summary = summarise(fitted.model, fitted.fit);
    const StraightnessError& error = summary.straightness->errors.front();
    held += std::abs(*error.value - 9.6) <= *error.expanded_uncertainty ? 1 : 0;
    EXPECT_LT(*error.expanded_uncertainty, 1.0);  // a tenth of what is there
  }
  EXPECT_GE(held, 4);
}

TEST(Curve, TellsWhatAPieceRoundsOff) {
  const std::vector<Profile> runs = twice_kinked(1);
  const auto told = [&](double piece_mm) {
    const FittedModel fitted =
        fit_declared(cases::problem(Lever::paper, 0, {curve(piece_mm)}), runs);
    return std::ranges::any_of(summarise(fitted.model, fitted.fit).notes, [](const auto& note) {
      return note.find("rounded off") != std::string::npos;
    });
  };
  EXPECT_TRUE(told(40.0));   // 50 µrad * 40 mm / 4 = 0.5 µm
  EXPECT_FALSE(told(10.0));  // 0.12 µm, less than U
}

// What a polynomial cannot make of it is in U; what a long curve shares with the polynomial is not,
// however high the degree. U is of 95 %, and 11 degrees of the same readings are one draw.
TEST(Curve, PolynomialOfAnyDegreeHoldsAWayCutShort) {
  const double at = 170.0, truth = largest_deviation(at);
  const std::vector<Profile> runs = cut_short(at, 7);
  for (int degree = 2; degree <= 12; ++degree) {
    const Problem problem =
        cases::problem(Lever::paper, 0, {cases::effect("straightness", degree)});
    const FittedModel fitted = fit_declared(problem, runs);
    const ModelResult summary = summarise(fitted.model, fitted.fit);
    const StraightnessError& error = summary.straightness->errors.front();
    EXPECT_NEAR(*error.value, truth, *error.expanded_uncertainty) << degree;
    EXPECT_LT(*error.expanded_uncertainty, truth) << degree;
  }
}

// A parabola is a polynomial of degree 2: nothing refutes it, and a line is refuted by it.
TEST(Curve, RefutesAPolynomialOfTooLowADegreeAndNoOther) {
  std::vector<Profile> runs;
  for (const char* name : {"first", "second"}) {
    RandomStream noise(5, name);
    const std::vector<double> x = cases::spaced(0.0, 200.0, 401);
    std::vector<double> z;
    for (const double each : x) z.push_back(1e-7 * each * each + 20e-6 * noise.normal());
    runs.push_back(cases::profile(name, Kind::slide, x, z));
  }
  const auto fitted = [&](int degree) {
    return fit_declared(cases::problem(Lever::paper, 0, {cases::effect("straightness", degree)}),
                        runs);
  };
  const FittedModel line = fitted(1), parabola = fitted(2);
  EXPECT_FALSE(line.fit.other_forms.empty());
  EXPECT_TRUE(parabola.fit.other_forms.empty());
  EXPECT_THAT(summarise(line.model, line.fit).notes,
              testing::Contains(testing::HasSubstr("refute degree 1 of the straightness")));
}

// Each profile has a form of its own: whichever comes first, the degree of both is refuted.
TEST(Curve, RefutesEachOfSeveralFormsInAnyOrder) {
  std::vector<Profile> runs;
  for (const char* name : {"first", "second"}) {
    RandomStream noise(5, name);
    const double cubic = std::string(name) == "first" ? 5e-10 : -1e-9;
    const std::vector<double> x = cases::spaced(0.0, 200.0, 401);
    std::vector<double> z;
    for (const double each : x) z.push_back(cubic * each * each * each + 20e-6 * noise.normal());
    runs.push_back(cases::profile(name, Kind::slide, x, z));
    runs.back().surface = name;
  }
  const auto uncertainties = [&] {
    std::vector<DeclaredEffect> forms;
    for (const Profile& run : runs) {
      forms.push_back(cases::effect("straightness", 2));
      forms.back().options.profiles = {run.name};
    }
    const FittedModel fitted = fit_declared(cases::problem(Lever::paper, 0, forms), runs);
    std::map<std::string, double> out;
    for (const FittedParameter& each : summarise(fitted.model, fitted.fit).parameters)
      if (each.expanded_uncertainty) out[each.name] = *each.expanded_uncertainty;
    EXPECT_EQ(fitted.fit.other_forms.size(), 2U);
    return out;
  };
  const std::map<std::string, double> forwards = uncertainties();
  std::ranges::reverse(runs);
  const std::map<std::string, double> backwards = uncertainties();
  ASSERT_EQ(forwards.size(), backwards.size());
  ASSERT_FALSE(forwards.empty());
  for (const auto& [name, u] : forwards) EXPECT_NEAR(backwards.at(name), u, 1e-6 * u) << name;
}

}  // namespace
}  // namespace slideway
