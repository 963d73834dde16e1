// What the carriage model lacks: each effect against its formula's numbers, worked out by hand or
// taken from the literature of the project (R = 10 mm, 110 rpm, feeds of 2 and 8 mm/min).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "effects/heights.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"

namespace slideway::terms_test {
namespace {

using namespace testing_support;

TEST(LinearDrift, RisesWithTheTimeOfTheCut) {
  // 10 nm/min: 50 nm in the 300 s of feed 2, 12.5 nm in the 75 s of feed 8.
  EXPECT_NEAR(height_um("linear_drift", face({0.0}), {0.01})[0], 0.05, 1e-15);
  EXPECT_NEAR(height_um("linear_drift", face({0.0}, 8.0), {0.01})[0], 0.0125, 1e-15);
  EXPECT_NEAR(height_um("linear_drift", face({10.0}, 2.0, CutDirection::outward), {0.01})[0], 0.05,
              1e-15);
}

TEST(ThermalDrift, ReachesSixtyThreePercentAtItsTimeConstant) {
  // Feed 2 inward: t = 120 s at r = 10 - 4 = 6 mm; 1 - 1/e = 0.632120558828558 (DLMF 4.2.11).
  const Eigen::VectorXd z = height_um("thermal_drift", face({10.0, 6.0}), {2.0, 120.0});
  EXPECT_EQ(z[0], 0.0);
  EXPECT_NEAR(z[1], 2.0 * 0.632120558828558, 1e-14);
}

TEST(ToolWear, GoesWithTheDistanceAlongTheSpiral) {
  // 17.28 m at feed 2, 4.32 m at feed 8: π R² n/F = π 100 mm² 110/2 = 17278.76 mm.
  EXPECT_NEAR(height_um("tool_wear", face({0.0}), {1.0})[0], 17.27875959474386, 1e-12);
  EXPECT_NEAR(height_um("tool_wear", face({0.0}, 8.0), {1.0})[0], 17.27875959474386 / 4, 1e-12);
}

TEST(ToolWear, IsExactlyRSquaredInBothDirections) {
  const std::vector<double> r = spaced(0, 10, 21);
  const Eigen::VectorXd inward = height_um("tool_wear", face(r), {1.0});
  const Eigen::VectorXd outward =
      height_um("tool_wear", face(r, 2.0, CutDirection::outward), {1.0});
  for (Eigen::Index i = 0; i < inward.size(); ++i) {
    EXPECT_NEAR(inward[i], inward[0] * (1.0 - r[i] * r[i] / 100.0), 1e-13);
    EXPECT_NEAR(outward[i], inward[0] * r[i] * r[i] / 100.0, 1e-13);
  }
}

TEST(ToolRunningIn, SettlesAfterItsDistance) {
  // s0 equal to the whole path: 1 - 1/e at the centre.
  const Eigen::VectorXd z =
      height_um("tool_running_in", face({10.0, 0.0}), {1.0, 17.27875959474386});
  EXPECT_EQ(z[0], 0.0);
  EXPECT_NEAR(z[1], 0.632120558828558, 1e-14);
}

TEST(Periodic, PhaseShiftsACosine) {
  // A cos(2πq + φ): at φ = π/3 and q = 0 it is A/2, a sixth of a period later -A/2.
  Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 600), {0.0, 10.0}};
  const Eigen::VectorXd z = height_um("slide_periodic", profile, {2.0, 60.0, kPi / 3});
  EXPECT_NEAR(z[0], 1.0, 1e-14);
  EXPECT_NEAR(z[1], -1.0, 1e-14);
}

// Distance after which the signal repeats, tested at many places.
void expect_period(const std::string& name, double feed, double rate, double period) {
  const Case here = face(spaced(1, 5, 19), feed);
  Case there = here;
  for (double& r : there.positions) r += period;
  const Eigen::VectorXd a = height_um(name, here, {1.0, rate, 0.3});
  const Eigen::VectorXd b = height_um(name, there, {1.0, rate, 0.3});
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-10) << name;  // 1e3 turns of 1e-13
  EXPECT_GT(a.cwiseAbs().maxCoeff(), 0.5) << name;
}

TEST(Periodic, EachVariableGivesItsOwnWavelengthOnTheFace) {
  for (const double feed : {2.0, 8.0}) {
    expect_period("slide_periodic", feed, 1.7, 1.7);                      // fixed in mm
    expect_period("time_periodic", feed, 30.0, feed * 0.5);               // feed times T
    expect_period("revolution_periodic", feed, 0.1, feed / 110.0 / 0.1);  // f/ν
    expect_period("traverse_periodic", feed, 50.0, 0.01);                 // v/f = 10 µm
  }
}

TEST(FeedMarks, RepeatOncePerTurnWithMeanZero) {
  // Groove centres at r = R - i f inward and r = i f outward; -1/3 there, 2/3 at the cusps.
  const double f = 2.0 / 110.0;
  const Eigen::VectorXd inward =
      height_um("feed_marks", face({10.0, 10.0 - 7 * f, 10.0 - 7.5 * f}), {1.0});
  EXPECT_NEAR(inward[0], -1.0 / 3, 1e-9);
  EXPECT_NEAR(inward[1], -1.0 / 3, 1e-9);
  EXPECT_NEAR(inward[2], 2.0 / 3, 1e-9);
  const Eigen::VectorXd outward =
      height_um("feed_marks", face({3 * f}, 2.0, CutDirection::outward), {1.0});
  EXPECT_NEAR(outward[0], -1.0 / 3, 1e-9);
  // Mid-point rule over one groove: the mean of a parabola to 1/(4 · 3 · n²) of its height.
  const Eigen::VectorXd groove =
      height_um("feed_marks", face(spaced(5 + f / 2000, 5 + f - f / 2000, 1000)), {1.0});
  EXPECT_NEAR(groove.mean(), 0.0, 1e-5);
}

TEST(FeedMarks, DoNotMoveWithTheStartOfTheCut) {
  Case late = face(spaced(0, 10, 77));
  const Eigen::VectorXd z = height_um("feed_marks", late, {1.0});
  late.setup.start_s = 77.7;
  EXPECT_LT((height_um("feed_marks", late, {1.0}) - z).cwiseAbs().maxCoeff(), 1e-9);
}

/// Heights of a face with marks of this amplitude, the parabola of a nose, and noise of 20 nm. mm
std::vector<double> marked(const Case& here, double amplitude_um, std::uint64_t seed) {
  const Eigen::VectorXd marks = height_um("feed_marks", here, {amplitude_um});
  RandomStream random(seed, "feed marks");
  std::vector<double> out;
  for (const double mark : marks) out.push_back(1e-3 * mark + 2e-5 * random.normal());
  return out;
}

std::optional<ShownBySamples> marks_shown(const Case& here, const std::vector<double>& values,
                                          double significance = 1e-3) {
  return specimen("feed_marks")
      .shown_by({here.positions, here.setup, lathe()}, values, significance);
}

TEST(FeedMarks, AreSeenInSamplesWithTheHarmonicsOfAParabola) {
  // 4u² - 1/3 = Σ_h 4 (-1)^h / (π² h²) cos 2πhu; grooves of 55 µm read every 12.4 µm.
  const Case here = face(spaced(0.3, 9.7, 760), 6.1);
  const double amplitude = 2.0;
  const auto shown = marks_shown(here, marked(here, amplitude, 7));
  ASSERT_TRUE(shown);
  ASSERT_GE(shown->options.harmonics.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const int h = shown->options.harmonics[k];
    EXPECT_EQ(h, static_cast<int>(k) + 1);
    const Prior& cosine = shown->values[2 * k];
    const double truth = 4.0 * amplitude * (h % 2 == 0 ? 1 : -1) / (kPi * kPi * h * h);
    // What the harmonics that are not shown put into it: the first of them is below the noise.
    EXPECT_NEAR(cosine.value, truth, 5.0 * cosine.standard_uncertainty) << h;
    EXPECT_LT(cosine.standard_uncertainty, 0.01) << h;
  }
}

// Read at the rate of the fifth harmonic, a wave of 0.5 µm: that of a parabola has 0.03 µm, and no
// convex edge leaves twice as much.
TEST(FeedMarks, HaveNoHarmonicThatAConvexEdgeCannotLeave) {
  const Case here = face(spaced(0.3, 9.7, 760), 6.1);
  std::vector<double> values = marked(here, 2.0, 7);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] += 0.5e-3 * std::cos(2.0 * kPi * 5.0 * here.positions[i] * 110.0 / 6.1);
  const auto shown = marks_shown(here, values);
  ASSERT_TRUE(shown);
  EXPECT_THAT(shown->options.harmonics, ::testing::IsSupersetOf({1, 2, 3}));
  EXPECT_THAT(shown->options.harmonics, ::testing::Not(::testing::Contains(5)));
}

// A groove every 2.017 samples: the line lies 3.3 cycles below half the sampling rate, and its
// mirror image as many above.
TEST(FeedMarks, AreSeenNearHalfTheSamplingRate) {
  const Case here = face(spaced(0.3, 9.7, 760), 2.7474);
  const double amplitude = 2.0;
  const auto shown = marks_shown(here, marked(here, amplitude, 7));
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->options.harmonics.front(), 1);
  EXPECT_NEAR(shown->values[0].value, -4.0 * amplitude / (kPi * kPi), 0.1 * amplitude);
}

// A groove in 0.993 of the distance of two samples: five cycles over the trace, where the form and
// slow effects are. The samples do not tell how large it is; a nose radius is a bound,
// H = f²/(8 r_ε) deep: f = 1.3533/110 mm, r_ε = 0.4 mm, H = 47.3 nm.
TEST(FeedMarks, AreBoundedByTheNoseWhereSamplingFoldsThemToASlowWave) {
  Case here = face(spaced(0.3, 9.7, 760), 1.3533);
  EXPECT_FALSE(marks_shown(here, marked(here, 2.0, 7)));
  here.setup.nose_radius_mm = 0.4;
  EXPECT_FALSE(marks_shown(here, marked(here, 0.0, 7)));
  const auto shown = marks_shown(here, marked(here, 2.0, 7));
  ASSERT_TRUE(shown);
  ASSERT_EQ(shown->options.harmonics.front(), 1);
  EXPECT_EQ(shown->values[0].value, 0.0);
  EXPECT_NEAR(shown->values[0].standard_uncertainty, 0.0473 / 2.0 / std::sqrt(3.0), 1e-4);
}

// Grooves as wide as a twelfth of the trace are a matter of the search: nothing folds them.
TEST(FeedMarks, AreNotBoundedWhereTheyAreWide) {
  Case here = face(spaced(0.3, 9.7, 760), 110.0);
  here.setup.nose_radius_mm = 0.4;
  EXPECT_FALSE(marks_shown(here, marked(here, 2.0, 7)));
}

// Over a diameter, across which the grooves of the far half lie half a turn apart, the lines beside
// one are those of the whole trace: half of a Hann window, from the axis on, would leak 5 % of it
// into them; the four grooves that are left out at the axis, 0.4 % of the trace, leak twice that.
TEST(FeedMarks, DoNotLeakBesideThemselvesOnADiameter) {
  Case here = face(spaced(0.0, 20.0, 760), 2.0);
  here.setup.center_mm = 10.0;
  const auto shown = marks_shown(here, marked(here, 2.0, 7));
  ASSERT_TRUE(shown);
  EXPECT_LT(shown->values[0].standard_uncertainty, 0.015 * std::abs(shown->values[0].value));
}

/// A diameter with grooves of 55 µm about an axis that lies `off` from where it is said to, 2 µm
/// deep: A (4u² - 1/3), u = (R - r)/f inward, half a turn later on the far half; noise of 20 nm.
std::pair<Case, std::vector<double>> diameter_off_centre(double off) {
  Case here = face(spaced(0.0, 20.0, 1517), 6.1);
  here.setup.center_mm = 10.0;
  here.setup.last_mm = 20.0;
  RandomStream random(7, "feed marks");
  std::vector<double> out;
  for (const double position : here.positions) {
    const double x = position - 10.0 - off;
    const double turns = (10.0 - std::abs(x)) * 110.0 / 6.1 - (x < 0.0 ? 0.5 : 0.0);
    const double u = turns - std::round(turns);
    out.push_back(2e-3 * (4.0 * u * u - 1.0 / 3.0) + 2e-5 * random.normal());
  }
  return {here, out};
}

// A quarter of a groove off, the first harmonic, -4A/π² cos 2πu, lies 90° further on one half and
// 90° less far on the other: opposite sines.
TEST(FeedMarks, OfADiameterOffItsCentreHaveAPhaseOnEachHalf) {
  const double off = 0.25 * 6.1 / 110.0, size = 4.0 * 2.0 / (kPi * kPi);
  const auto [here, values] = diameter_off_centre(off);
  const auto shown = marks_shown(here, values);
  ASSERT_TRUE(shown);
  EXPECT_TRUE(shown->options.each_half);
  ASSERT_EQ(shown->options.harmonics.front(), 1);
  ASSERT_EQ(shown->values[3].parameter, "sin1_far_um");
  EXPECT_NEAR(shown->values[0].value, 0.0, 0.05 * size);
  EXPECT_NEAR(shown->values[2].value, 0.0, 0.05 * size);
  EXPECT_NEAR(std::abs(shown->values[1].value), size, 0.05 * size);
  EXPECT_NEAR(shown->values[3].value, -shown->values[1].value, 0.05 * size);
}

TEST(FeedMarks, OfACentredDiameterHaveOnePhase) {
  const auto [here, values] = diameter_off_centre(0.0);
  const auto shown = marks_shown(here, values);
  ASSERT_TRUE(shown);
  EXPECT_FALSE(shown->options.each_half);
}

TEST(FeedMarks, OfEachHalfAreThoseOfTheHalvesAlone) {
  EffectOptions options;
  options.harmonics = {1, 2};
  options.each_half = true;
  const auto effect = make_effect("feed_marks", options, lathe(), {});
  ASSERT_EQ(effect->amplitudes(), 8);
  const Case here = diameter_off_centre(0.0).first;
  Eigen::MatrixXd columns(std::ssize(here.positions), 8);
  effect->columns({here.positions, here.setup, lathe()}, {}, columns);
  const auto far = static_cast<Eigen::Index>(here.positions.size() / 2);
  EXPECT_EQ(columns.topRows(far)(Eigen::all, {0, 1, 4, 5}).norm(), 0.0);
  EXPECT_EQ(columns.bottomRows(far)(Eigen::all, {2, 3, 6, 7}).norm(), 0.0);
  // A cosine and a sine: the squares of the two are 1 at every station.
  EXPECT_NEAR(columns.col(0).squaredNorm() + columns.col(1).squaredNorm(),
              static_cast<double>(columns.rows() - far), 1e-9);
  EXPECT_THROW(static_cast<void>(make_effect("feed_marks", {.each_half = true}, lathe(), {})),
               UsageError);
}

TEST(FeedMarks, AreNotSeenInNoise) {
  const Case here = face(spaced(0.3, 9.7, 760), 6.1);
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed)
    alarms += marks_shown(here, marked(here, 0.0, seed), 0.01).has_value();
  EXPECT_LE(alarms, 12);  // of 4 expected; more in 3e-4 of all choices of the seeds
}

TEST(Step, LiftsEverythingInsideItsRadius) {
  const Eigen::VectorXd z = height_um("step", face({0.0, 3.9, 4.0, 10.0}), {0.5, 4.0});
  EXPECT_DOUBLE_EQ(z[0], 0.5);
  EXPECT_DOUBLE_EQ(z[1], 0.5);
  EXPECT_EQ(z[2], 0.0);
  EXPECT_EQ(z[3], 0.0);
}

TEST(CentreHeight, IsAHyperbolaWithItsNubAtTheAxis) {
  // h = 3, r = 4: (5 - 4)/3.
  const Eigen::VectorXd z = height_um("centre_height", face({0.0, 4.0}), {1.0, 3.0});
  EXPECT_DOUBLE_EQ(z[0], 1.0);
  EXPECT_NEAR(z[1], 1.0 / 3, 1e-15);
}

TEST(SpeedEffect, IsZeroAtTheRimAndCappedAtTheCentre) {
  // m = 1/2: (r/R)^-1/2 - 1 is 1 at r = R/4; below 0.02 mm it stays at sqrt(500) - 1.
  const Eigen::VectorXd z = height_um("speed_effect", face({10.0, 2.5, 0.01, 0.0}), {1.0, 0.5});
  EXPECT_EQ(z[0], 0.0);
  EXPECT_NEAR(z[1], 1.0, 1e-14);
  EXPECT_NEAR(z[2], std::sqrt(500.0) - 1.0, 1e-12);
  EXPECT_EQ(z[2], z[3]);
}

TEST(EdgeRollOff, FallsToOneOverEWithinItsWidth) {
  const Eigen::VectorXd z = height_um("edge_roll_off", face({10.0, 9.5}), {1.0, 0.5});
  EXPECT_DOUBLE_EQ(z[0], 1.0);
  EXPECT_NEAR(z[1], 0.367879441171442, 1e-14);
}

TEST(Cup, IsAParabolaOfTheStatedSag) {
  const Eigen::VectorXd z = height_um("cup", face({0.0, 5.0, 10.0}), {0.8});
  EXPECT_EQ(z[0], 0.0);
  EXPECT_NEAR(z[1], 0.2, 1e-15);
  EXPECT_NEAR(z[2], 0.8, 1e-15);
}

TEST(OddEffects, ChangeSignAcrossTheAxis) {
  Case diameter{"", setup_of(Kind::face, Quantity::height, 2, 22), {2.0, 7.0, 12.0, 17.0, 22.0}};
  diameter.setup.center_mm = 12.0;
  const Eigen::VectorXd cubic = height_um("traverse_datum", diameter, {1.0});
  const Eigen::VectorXd step = height_um("centre_step", diameter, {1.0});
  const double cubes[] = {-1.0, -0.125, 0.0, 0.125, 1.0};
  const double signs[] = {-1.0, -1.0, 0.0, 1.0, 1.0};
  for (Eigen::Index i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(cubic[i], cubes[i]);
    EXPECT_DOUBLE_EQ(step[i], signs[i]);
  }
}

TEST(CentreStep, IsOfNoUseOnARadius) {
  EXPECT_FALSE(make("centre_step")->applies_to(face({0.0}).setup));
  EXPECT_TRUE(make("centre_step")->applies_to(all_cases()[2].setup));
}

TEST(SpindleRunout, GrowsAlongTheReading) {
  // 60 rpm and 60 mm/min: one turn per second and per mm. cos 2πhk is 1 at whole mm; the growth
  // counts -1 at the first and +1 at the last position.
  Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 100), {0.0, 50.0, 100.0, 100.25}};
  profile.setup.feed_mm_per_min = 60.0;
  profile.setup.spindle_rpm = 60.0;
  profile.setup.cut_direction = CutDirection::outward;
  const Eigen::VectorXd first =
      height_um("spindle_runout", profile, {1.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 60.0});
  EXPECT_NEAR(first[0], 0.5, 1e-12);
  EXPECT_NEAR(first[1], 1.0, 1e-12);
  EXPECT_NEAR(first[2], 1.5, 1e-12);
  EXPECT_NEAR(first[3], 0.0, 1e-12);  // a quarter turn
  const Eigen::VectorXd second =
      height_um("spindle_runout", profile, {0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 60.0});
  EXPECT_NEAR(second[3], -1.0, 1e-12);
}

// A phase q P_2(τ), P_2 = (3τ² - 1)/2, is q at both ends and -q/2 in the middle; a quarter turn
// makes a cosine of the wave into nothing, half a turn into its negative.
TEST(SpindleRunout, DriftOfTheSpeedTurnsThePhase) {
  Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 100), {0.0, 50.0, 100.0}};
  profile.setup.feed_mm_per_min = 60.0;  // whole turns at whole mm
  profile.setup.spindle_rpm = 60.0;
  const auto effect = make_effect("spindle_runout", {.degree = 2}, lathe(), kTravel);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(10);
  values[0] = 1.0;
  values[8] = 60.0;
  values[9] = 0.5;
  for (const CutDirection direction : {CutDirection::inward, CutDirection::outward}) {
    profile.setup.cut_direction = direction;
    const Eigen::VectorXd z = signal(*effect, profile, values) * 1e3;
    EXPECT_NEAR(z[0], -1.0, 1e-12);
    EXPECT_NEAR(z[1], 0.0, 1e-12);
    EXPECT_NEAR(z[2], -1.0, 1e-12);
  }
}

// The phase of a drifting wave, 6500 turns long, against the formula. As an angle that is 4e4 rad,
// known to 7e-12.
TEST(SpindleRunout, ADriftingWaveIsThatOfItsFormula) {
  Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 650), spaced(0, 650, 25001)};
  profile.setup.feed_mm_per_min = 60.0;
  profile.setup.spindle_rpm = 600.0;
  profile.setup.cut_direction = CutDirection::outward;
  const auto effect = make_effect("spindle_runout", {.degree = 2}, lathe(), kTravel);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(10);
  values[0] = 1.0;
  values[8] = 600.0;
  values[9] = 3.0;
  const Eigen::VectorXd z = signal(*effect, profile, values) * 1e3;
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double t = profile.positions[static_cast<std::size_t>(i)];  // s at 60 mm/min
    const double tau = t / 325.0 - 1.0;
    const double turns = t * 10.0 + 3.0 * (3.0 * tau * tau - 1.0) / 2.0;
    ASSERT_NEAR(z[i], std::cos(2.0 * kPi * turns), 1e-10) << t;
  }
}

// P_3 is odd: what a reading has at its start it has with the other sign at its end.
TEST(SpindleRunout, AnOddDriftFollowsTheTimeAndNotThePosition) {
  Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 100), {0.0, 100.0}};
  profile.setup.feed_mm_per_min = 60.0;
  profile.setup.spindle_rpm = 60.0;
  const auto effect = make_effect("spindle_runout", {.degree = 3}, lathe(), kTravel);
  Eigen::VectorXd values = Eigen::VectorXd::Zero(11);
  values[1] = 1.0;  // a sine
  values[8] = 60.0;
  values[10] = 0.25;
  for (const double sign : {1.0, -1.0}) {
    profile.setup.cut_direction = sign > 0.0 ? CutDirection::outward : CutDirection::inward;
    const Eigen::VectorXd z = signal(*effect, profile, values) * 1e3;
    EXPECT_NEAR(z[0], -sign, 1e-12);
    EXPECT_NEAR(z[1], sign, 1e-12);
  }
}

// The rate of t n/60 + q P_2(τ) over the reading changes from -3q·2 to 3q·2 cycles, P_2' = 3τ.
TEST(SpindleRunout, ItsLinesCoverTheDrift) {
  Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 100), spaced(0, 100, 10001)};
  profile.setup.feed_mm_per_min = 60.0;
  profile.setup.spindle_rpm = 60.0;
  const Stations stations(profile.positions, profile.setup, lathe());
  const auto effect = make_effect("spindle_runout", {.degree = 2}, lathe(), kTravel);
  const std::vector<LineBand> lines = effect->lines(stations, std::vector<double>{60.0, 0.5});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_NEAR(lines[0].low, 97.0, 1e-3);  // steps of the profile: a chord over 1e-4 of it
  EXPECT_NEAR(lines[0].high, 103.0, 1e-3);
  EXPECT_NEAR(lines[1].high, 206.0, 2e-3);
}

// At 60 and at 90 1/min: the speed that is searched, 61, is that of the first reading alone.
TEST(SpindleRunout, KeepsToTheSpeedOfEachReading) {
  for (const auto& [nominal, turns] : {std::pair{60.0, 61.0}, std::pair{90.0, 90.0}}) {
    Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 100), {0.0, 0.25, 7.0}};
    profile.setup.feed_mm_per_min = 60.0;
    profile.setup.spindle_rpm = nominal;
    profile.setup.cut_direction = CutDirection::outward;
    const Eigen::VectorXd z =
        height_um("spindle_runout", profile, {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 61.0});
    for (Eigen::Index i = 0; i < 3; ++i)
      EXPECT_NEAR(
          z[i], std::cos(2.0 * kPi * turns / 60.0 * profile.positions[static_cast<std::size_t>(i)]),
          1e-12);
  }
}

// Along a slide the first two orders of the turn are the run-out's, 600 turns here; a cycle beside
// them, and on a face, a motion is asynchronous.
TEST(Periodic, AlongASlideAnAsynchronousMotionIsNoRunOut) {
  Case profile{"", setup_of(Kind::slide, Quantity::height, 0, 600), spaced(0, 600, 2401)};
  profile.setup.feed_mm_per_min = 60.0;
  profile.setup.spindle_rpm = 60.0;
  profile.setup.cut_direction = CutDirection::outward;
  const auto size = [&](double cycles) {
    return height_um("revolution_periodic", profile, {1.0, cycles, 0.0}).norm();
  };
  for (const double order : {1.0, 2.0}) {
    EXPECT_EQ(size(order), 0.0);
    EXPECT_EQ(size(order + 0.9 / 600.0), 0.0);
    EXPECT_GT(size(order - 1.1 / 600.0), 1.0);
  }
  EXPECT_GT(size(0.5), 1.0);
}

TEST(SpindleRunout, AFaceKnowsNoDrift) {
  const auto effect = make_effect("spindle_runout", {.degree = 2}, lathe(), kTravel);
  EXPECT_FALSE(effect->applies_to(all_cases()[0].setup));
  EXPECT_TRUE(make("spindle_runout")->applies_to(all_cases()[0].setup));
}

// At 0.99 cycles a turn a line goes round once in a hundred turns, 550 of them here, counted to
// half a turn.
TEST(Periodic, ALineNearOneCycleATurnIsSlow) {
  Case diameter = face(spaced(-10, 10, 2001));
  diameter.setup.first_mm = -10.0;
  const Stations stations(diameter.positions, diameter.setup, lathe());
  const std::vector<double> rate{0.99};
  const std::vector<LineBand> lines = make("revolution_periodic")->lines(stations, rate);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0].low, 5.5, 0.006);
  EXPECT_NEAR(lines[0].high, 5.5, 0.006);
}

TEST(SearchRange, StaysWithinWhatTheProfileShows) {
  const Case profile = face(spaced(0, 10, 1001));  // 0.01 mm, 0.3 s, 0.55 turns a step; 300 s
  const Stations stations(profile.positions, profile.setup, lathe());
  const auto near = [](std::pair<double, double> range, double low, double high) {
    // Sums of a thousand steps.
    EXPECT_NEAR(range.first, low, 2e-9 * low);
    EXPECT_NEAR(range.second, high, 2e-9 * high);
  };
  near(make("time_periodic")->search_range(0, stations), 1.2, 600.0);
  near(make("thermal_drift")->search_range(0, stations), 1.2, 3000.0);
  near(make("slide_periodic")->search_range(0, stations), 0.1, 10.0);
  near(make("revolution_periodic")->search_range(0, stations), 1.0 / 1100.0, 1.0 / 2.2);
  // A diameter has two grooves a turn, so a line up to one cycle a turn is itself; two periods of
  // it on either half.
  Case diameter = face(spaced(-10, 10, 2001));
  diameter.setup.first_mm = -10.0;
  const Stations both(diameter.positions, diameter.setup, lathe());
  near(make("revolution_periodic")->search_range(0, both), 1.0 / 1100.0, 1.0 - 2.0 / 550.0);
  // One groove per turn samples a face: another speed would be another alias.
  near(make("spindle_runout")->search_range(0, stations), 110.0, 110.0);
  near(make("step")->search_range(0, stations), 0.01, 9.99);
}

}  // namespace
}  // namespace slideway::terms_test
