// Readings along the slide: height, local slope, slope over a base.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/effect_cases.hpp"
#include "groove.hpp"
#include "variable_range.hpp"

namespace slideway::readings_test {
namespace {

using namespace testing_support;

Case slide(Quantity quantity, std::optional<double> base = {}) {
  Case profile{"slide", setup_of(Kind::slide, quantity, 0, 600), spaced(0, 600, 31)};
  profile.setup.base_mm = base;
  return profile;
}

// Straightness of degree 3 whose only coefficient is b_k = 1.
Eigen::VectorXd power(int k, const Case& profile) {
  const auto effect = make("straightness", kTravel, Lever::paper, 3);
  return signal(*effect, profile, Eigen::VectorXd::Unit(4, k));
}

TEST(SlideReadings, HeightIsThePolynomialWithoutAnyLever) {
  const Case profile = slide(Quantity::height);
  const Eigen::VectorXd z = power(3, profile);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    EXPECT_NEAR(z[i], std::pow(profile.positions[i], 3), 1e-13 * 2.16e8);
}

TEST(SlideReadings, LocalSlopeIsTheDerivative) {
  const Case profile = slide(Quantity::slope);
  const Eigen::VectorXd z = power(3, profile);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    EXPECT_NEAR(z[i], 3.0 * std::pow(profile.positions[i], 2), 1e-13 * 1.08e6);
}

TEST(SlideReadings, SlopeOverABaseIsTheChordOverItsFeet) {
  // ((x + B/2)³ - (x - B/2)³)/B = 3x² + B²/4, worked out by hand, B = 100 mm.
  const Case profile = slide(Quantity::slope, 100.0);
  const Eigen::VectorXd z = power(3, profile);
  for (Eigen::Index i = 0; i < z.size(); ++i)
    EXPECT_NEAR(z[i], 3.0 * std::pow(profile.positions[i], 2) + 2500.0, 1e-12 * 1.08e6);
}

TEST(SlideReadings, SlopeOverAShrinkingBaseBecomesTheLocalSlope) {
  const auto effect = make("slide_periodic");
  Eigen::VectorXd values(3);
  values << 1.0, 80.0, 0.4;
  const Eigen::VectorXd local = signal(*effect, slide(Quantity::slope), values);
  double previous = 0.0;
  for (const double base : {8.0, 4.0, 2.0, 1.0}) {
    const double error = (signal(*effect, slide(Quantity::slope, base), values) - local).norm();
    // sinc: the error goes with the square of the base, its next term is (πB/λ)²/20 of it.
    if (previous > 0.0) {
      EXPECT_NEAR(previous / error, 4.0, 0.03);
    }
    previous = error;
  }
}

TEST(SlideReadings, BaseAveragesAWaveByTheSinc) {
  // A base of one period sees nothing; of half a period 2/π of the local slope.
  const auto effect = make("slide_periodic");
  Eigen::VectorXd values(3);
  values << 1.0, 80.0, 0.4;
  const Eigen::VectorXd local = signal(*effect, slide(Quantity::slope), values);
  const Eigen::VectorXd whole = signal(*effect, slide(Quantity::slope, 80.0), values);
  const Eigen::VectorXd half = signal(*effect, slide(Quantity::slope, 40.0), values);
  EXPECT_LT(whole.norm(), 1e-13 * local.norm());
  EXPECT_LT((half - 2.0 / kPi * local).norm(), 1e-13 * local.norm());
}

// 0.3 a minute from the first reading of all on, be it µm or µrad; turned over, the other way.
TEST(InstrumentReadings, ZeroDriftsWithTheTimeOfTheReading) {
  TravelRange session = kTravel;
  session.read = {{"there", 700.0, 900.0}, {"back", 910.0, 1000.0}};
  const auto effect = make("zero_drift", session);
  const Eigen::VectorXd rate = Eigen::VectorXd::Constant(1, 0.3);
  for (Case each : {slide(Quantity::height), slide(Quantity::slope, 100.0)}) {
    const double unit = each.setup.quantity == Quantity::height ? 1e-3 : 1e-6;
    each.positions = {0.0, 300.0, 600.0};  // read at 1000, 880 and 720 s
    const Eigen::VectorXd z = signal(*effect, each, rate);
    each.setup.reversed = true;
    const Eigen::VectorXd turned = signal(*effect, each, rate);
    for (const auto& [i, minutes] : {std::pair(0, 5.0), std::pair(1, 3.0), std::pair(2, 1.0 / 3)})
      EXPECT_NEAR(z[i], unit * 0.3 * minutes, 1e-15 * unit);
    EXPECT_EQ(turned, -z);
  }
}

// From 700 to 1000 s it makes 0.3 times five minutes; the parabola through 0 at both ends has as
// much in the middle, and 4 · 180 · 120 / 300 s = 4.8 minutes of it at 880 s.
TEST(InstrumentReadings, ZeroMayBendByAParabolaOverTheSession) {
  TravelRange session = kTravel;
  session.read = {{"there", 700.0, 900.0}, {"back", 910.0, 1000.0}};
  const Departures departures = make("zero_drift", session)->departures();
  EXPECT_TRUE(departures.of_law);
  ASSERT_EQ(departures.parts.size(), 1u);
  Case each = slide(Quantity::height);
  each.positions = {0.0, 300.0};  // read at 1000 and 880 s
  const Eigen::VectorXd z = signal(*departures.parts[0], each, Eigen::VectorXd::Constant(1, 0.3));
  EXPECT_NEAR(z[0], 0.0, 1e-15);
  EXPECT_NEAR(z[1], 1e-3 * 0.3 * 4.8, 1e-15);
}

// P_2 = (3 u² - 1) / 2 and P_3 = (5 u³ - 3 u) / 2 of u = x / 300 - 1.
TEST(InstrumentReadings, FormOfAnArtefactIsReadWithTheSignOfItsPosition) {
  const auto effect = make("artefact_form", kTravel, Lever::paper, 3);
  Eigen::VectorXd values(2);
  values << 0.5, -0.2;
  const auto form = [](double x) {
    const double u = x / 300.0 - 1.0;
    return 1e-3 * (0.25 * (3.0 * u * u - 1.0) - 0.1 * (5.0 * u * u * u - 3.0 * u));
  };
  Case height = slide(Quantity::height);
  const Case chord = slide(Quantity::slope, 100.0);
  const Eigen::VectorXd z = signal(*effect, height, values), m = signal(*effect, chord, values);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double x = height.positions[static_cast<std::size_t>(i)];
    EXPECT_NEAR(z[i], form(x), 1e-17);
    EXPECT_NEAR(m[i], (form(x + 50.0) - form(x - 50.0)) / 100.0, 1e-17);
  }
  height.setup.reversed = true;
  EXPECT_EQ(signal(*effect, height, values), -z);
  const slideway::Setup turned = height.setup, as_it_was = chord.setup;
  EXPECT_TRUE(effect->lacking_together({&turned, &as_it_was}).empty());
  EXPECT_EQ(effect->lacking_together({&turned, &turned}).size(), 1U);
}

TEST(InstrumentReadings, ZeroIsTheSameInAllLinesButATurnedOne) {
  Case line = slide(Quantity::slope, 100.0);
  const Eigen::VectorXd zero = Eigen::VectorXd::Constant(1, 20.0);
  EXPECT_TRUE(signal(*make("instrument_zero"), line, zero).isConstant(20e-6, 1e-15));
  line.setup.reversed = true;
  EXPECT_TRUE(signal(*make("instrument_zero"), line, zero).isConstant(-20e-6, 1e-15));
}

TEST(SlideReadings, SlopesSeeNoDriftOfHeight) {
  const slideway::Setup slope = slide(Quantity::slope).setup;
  for (const char* name :
       {"thermal_drift", "linear_drift", "time_periodic", "revolution_periodic", "spindle_runout",
        "traverse_periodic", "squareness", "vertical_straightness", "tool_wear", "cup"})
    EXPECT_FALSE(make(name)->applies_to(slope)) << name;
  for (const char* name : {"straightness", "gantry_sag", "slide_periodic"})
    EXPECT_TRUE(make(name)->applies_to(slope)) << name;
}

// On either side of the spindle axis these variables run one way, so that the ends of both sides
// say what all stations do: to rounding, some hundred sums of numbers of up to 1e5.
TEST(VariableRange, OfTheEndsIsThatOfAllStations) {
  std::vector<Case> profiles = all_cases();
  for (const double center : {-20.0, -9.9, -3.0, 10.0}) {  // beside the trace, on it, at its end
    profiles.push_back(profiles[2]);
    profiles.back().setup.center_mm = center;
  }
  const Machine machine(Machine::paper_lathe(), Lever::paper);
  for (const Case& profile : profiles) {
    const Stations stations{profile.positions, profile.setup, machine};
    std::vector<VariableReading> readings_of = {slide_of, radius_of,     measuring_time_of,
                                                time_of,  revolution_of, cutting_time_of};
    if (profile.setup.kind == Kind::face) readings_of.push_back(distance_m_of);
    for (std::size_t v = 0; v < readings_of.size(); ++v) {
      const VariableRange ends = range_of(stations, readings_of[v]),
                          all = range_of(readings(stations, readings_of[v]));
      const double rounding = 1e-12 * (std::abs(all.low) + std::abs(all.high));
      EXPECT_EQ(ends.low, all.low) << profile.name << v;
      EXPECT_EQ(ends.high, all.high) << profile.name << v;
      EXPECT_NEAR(ends.step, all.step, rounding) << profile.name << v;
    }
  }
}

}  // namespace
}  // namespace slideway::readings_test
