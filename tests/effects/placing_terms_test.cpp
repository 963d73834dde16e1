// What depends on where a trace or a form lies: each effect against its formula's numbers, worked
// out by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "effects/heights.hpp"

namespace slideway::placing_terms_test {
namespace {

using namespace testing_support;

// At X = ±R/2 two lobes have a quarter, three an eighth, odd ones with the sign of X.
TEST(ChuckingLobes, ArePowersOfTheRadiusWithTheSymmetryOfTheirNumber) {
  Case diameter{"", setup_of(Kind::face, Quantity::height, -10, 10), {-5.0, 0.0, 5.0, 10.0}};
  const auto expect = [&](std::initializer_list<double> values, double near, double rim,
                          double sign) {
    const Eigen::VectorXd z = height_um("chucking_lobes", diameter, values);
    EXPECT_NEAR(z[0], sign * near, 1e-15);
    EXPECT_EQ(z[1], 0.0);
    EXPECT_NEAR(z[2], near, 1e-15);
    EXPECT_NEAR(z[3], rim, 1e-15);
  };
  expect({1, 0, 0, 0, 0, 0}, 0.25, 1.0, 1.0);
  expect({0, 0, 1, 0, 0, 0}, 0.125, 1.0, -1.0);
  expect({0, 0, 0, 0, 1, 0}, 0.0625, 1.0, 1.0);
  diameter.setup.azimuth_deg = 30.0;  // cos 60° and sin 60°; cos 90° and sin 90°; cos 120°
  expect({1, 0, 0, 0, 0, 0}, 0.125, 0.5, 1.0);
  expect({0, 1, 0, 0, 0, 0}, std::sqrt(3.0) / 8.0, std::sqrt(3.0) / 2.0, 1.0);
  expect({0, 0, 1, 0, 0, 0}, 0.0, 0.0, -1.0);
  expect({0, 0, 0, 1, 0, 0}, 0.125, 1.0, -1.0);
  expect({0, 0, 0, 0, 1, 0}, -0.03125, -0.5, 1.0);
}

// r^n cos nθ is harmonic: its mean over a circle is its value at the centre, 0.
TEST(ChuckingLobes, VanishInTheMeanOverACircle) {
  Case radius = face({7.0});
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(6);
  double sum = 0.0;
  for (int i = 0; i < 12; ++i) {
    radius.setup.azimuth_deg = 30.0 * i;
    sum += signal(*make("chucking_lobes"), radius, all)[0];
  }
  EXPECT_NEAR(sum, 0.0, 1e-15);
}

TEST(ChuckingLobes, NeedThreeDirections) {
  const auto effect = make("chucking_lobes");
  const auto lacking = [&](const std::vector<double>& azimuths) {
    std::vector<slideway::Setup> setups(azimuths.size(), all_cases()[2].setup);
    std::vector<const slideway::Setup*> all;
    for (std::size_t i = 0; i < setups.size(); ++i) {
      setups[i].azimuth_deg = azimuths[i];
      all.push_back(&setups[i]);
    }
    return effect->lacking_together(all);
  };
  EXPECT_EQ(lacking({0.0, 60.0, 120.0}).size(), 0U);
  EXPECT_EQ(lacking({0.0, 60.0, 180.0}),  // a diameter looks both ways
            std::vector<std::string>{"azimuth_deg of at least three traces in three directions"});
}

// At one width from its place a Gaussian has exp(-1/2) of its height and its largest slope, A/w
// times that; a base from -w to w around the place sees no difference.
TEST(LocalForm, IsAGaussianInHeightSlopeAndOverABase) {
  const Case heights = {"", setup_of(Kind::slide, Quantity::height, 0, 600), {100.0, 110.0, 600.0}};
  const Eigen::VectorXd z = height_um("local_form", heights, {2.0, 100.0, 10.0});
  EXPECT_DOUBLE_EQ(z[0], 2.0);
  EXPECT_NEAR(z[1], 2.0 * std::exp(-0.5), 1e-14);
  EXPECT_EQ(z[2], 0.0);
  Case slopes = {"", setup_of(Kind::slide, Quantity::slope, 0, 600), {100.0, 110.0}};
  const Eigen::VectorXd bump = values({2.0, 100.0, 10.0});
  const Eigen::VectorXd local = signal(*make("local_form"), slopes, bump);
  EXPECT_EQ(local[0], 0.0);
  EXPECT_NEAR(local[1], -2e-3 / 10.0 * std::exp(-0.5), 1e-17);
  slopes.setup.base_mm = 20.0;
  const Eigen::VectorXd bridge = signal(*make("local_form"), slopes, bump);
  EXPECT_NEAR(bridge[0], 0.0, 1e-19);
  EXPECT_NEAR(bridge[1], 2e-3 / 20.0 * (std::exp(-2.0) - 1.0), 1e-17);
}

TEST(LocalForm, OfTheWayStaysAtItsPlaceOfTheSlide) {
  Case at_axis = face({5.0});
  at_axis.setup.spindle_position_mm = 100.0;
  EXPECT_DOUBLE_EQ(height_um("local_form", at_axis, {1.0, 105.0, 1.0})[0], 1.0);
}

// A cone Θ r read off the centre by X0 is Θ |X - X0|, so that Θ (|X - X0| - |X|) is added.
TEST(Centring, IsAConeOffTheCentre) {
  const Case diameter{"", setup_of(Kind::face, Quantity::height, -10, 10), {-5.0, 0.0, 0.2, 2.5}};
  const double cone = 0.2;  // µm/mm
  for (const double off : {0.5, -0.5}) {
    const Eigen::VectorXd z = height_um("centring", diameter, {-cone * off, off});
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const double x = diameter.positions[static_cast<std::size_t>(i)];
      EXPECT_NEAR(z[i], cone * (std::abs(x - off) - std::abs(x)), 1e-15);
    }
  }
  EXPECT_FALSE(make("centring")->applies_to(face({0.0}).setup));
}

// Off the centre by X0 a parabola z = a r² has a X0² - 2 a X0 X more: a tilt. Of a slope that grows
// from 0 at the axis as 2 a r, the column is -2 a r sgn X in proportion.
TEST(Centring, GoesWithTheSlopeOfTheFace) {
  FaceSlope parabola;
  parabola.spacing_mm = 1.0;
  for (int r = 0; r <= 10; ++r) parabola.values.push_back(2.0 * r);
  EXPECT_DOUBLE_EQ(parabola.at(2.5), 5.0);
  EXPECT_DOUBLE_EQ(parabola.at(12.0), 20.0);
  EXPECT_DOUBLE_EQ(parabola.rms(), 2.0 * std::sqrt(385.0 / 11.0));  // of 0, 1, ..., 10
  TravelRange range;
  range.face_slope = std::make_shared<const FaceSlope>(parabola);
  const Case diameter{"", setup_of(Kind::face, Quantity::height, -10, 10), {-5.0, -2.5, 2.5, 10.0}};
  const auto effect = make_effect("centring", {}, lathe(), range);
  const Eigen::VectorXd z = signal(*effect, diameter, values({1.0, 0.5})) / kMicrometre;
  const double whole = parabola.rms();
  EXPECT_NEAR(z[0], -10.0 / whole, 1e-14);
  EXPECT_NEAR(z[1], -5.0 / whole, 1e-14);
  EXPECT_NEAR(z[2], 5.0 / whole, 1e-14);
  EXPECT_NEAR(z[3], 20.0 / whole, 1e-14);
}

/// An effect of a face that is known to be a cone of 200 µm/m.
std::unique_ptr<Effect> on_cone(const char* name) {
  FaceSlope cone;
  cone.values = {2e-4, 2e-4};
  TravelRange range;
  range.face_slope = std::make_shared<const FaceSlope>(cone);
  return make_effect(name, {}, lathe(), range);
}

// The step is A = -X0 z'_rms whatever the width of the ramp seems to be, which few values show.
TEST(Centring, HasTheOffsetThatMakesItsStep) {
  const auto effect = on_cone("centring");
  const std::vector<double> wide{2.0};
  const ParameterValues known =
      effect->parameter_values(Eigen::VectorXd::Constant(1, -0.1 * kMicrometre), wide);
  EXPECT_DOUBLE_EQ(known.values[1], 0.5);  // 0.1 µm / (200 µm/m), mm
  EXPECT_DOUBLE_EQ(known.jacobian(1, 0), -1.0 / 2e-4);
  EXPECT_EQ(known.jacobian(1, 1), 0.0);
}

TEST(Centring, WithoutAnOffsetIsTheCentreStep) {
  const Case diameter = all_cases()[2];
  const std::vector<double> none{0.0};
  EXPECT_EQ(columns(*make("centring"), diameter, none), columns(*make("centre_step"), diameter));
}

/// Height 1 mm beside the axis of a cone of 200 µm/m read beside the diameter by d mm, µm.
double chord_height(double d) { return 0.2 * (std::hypot(1.0, d) - 1.0); }

// 3, 4, 5: a cone at r = 4 mm read beside the diameter by 3 mm is that at 5 mm.
TEST(Chord, IsTheConeFurtherOut) {
  const Eigen::VectorXd z = height_um("chord", face({4.0, 0.0}), {chord_height(3.0), 3.0});
  EXPECT_NEAR(z[0], 0.2 * (5.0 - 4.0), 1e-15);
  EXPECT_NEAR(z[1], 0.2 * 3.0, 1e-15);
}

TEST(Chord, IsTheNubOfATooHighTool) {
  const Case profile = face(spaced(0, 10, 21));
  const Eigen::VectorXd chord = height_um("chord", profile, {chord_height(0.5), 0.5});
  const Eigen::VectorXd nub = height_um("centre_height", profile, {0.2 * 0.5, 0.5});
  EXPECT_LT((chord - nub).norm(), 1e-14 * nub.norm());
}

// Where the slope of the face is known, the height alone tells the distance, whatever the width of
// the form seems to be; its derivative is that of the height the other way round. A form that falls
// where the face rises is of no trace.
TEST(Chord, IsAtTheDistanceThatMakesItsHeight) {
  const auto effect = on_cone("chord");
  const auto with_height = [&](double micrometres) {
    const std::vector<double> wide{2.0};
    return effect->parameter_values(Eigen::VectorXd::Constant(1, micrometres * kMicrometre), wide);
  };
  for (const double d : {0.05, 0.5, 3.0}) {
    const ParameterValues known = with_height(chord_height(d));
    EXPECT_NEAR(known.values[1], d, 1e-11);  // cancellation: of 1.001 mm, 1e-13 in d²
    const double slope = 2e-4 * d / std::hypot(1.0, d);
    EXPECT_NEAR(known.jacobian(1, 0) * slope, 1.0, 1e-9);
    EXPECT_EQ(known.jacobian(1, 1), 0.0);
  }
  EXPECT_LT(with_height(-0.01).values[1], effect->parameters()[1].lower);
}

TEST(Hysteresis, ChangesSignWithTheDirection) {
  Case cut = face({0.0, 5.0, 10.0});
  cut.setup.cut_direction = CutDirection::outward;
  const Eigen::VectorXd out = height_um("hysteresis", cut, {0.1, 0.2, 0.4});
  EXPECT_NEAR(out[0], 0.1, 1e-16);
  EXPECT_NEAR(out[1], 0.1 + 0.1 + 0.1, 1e-15);
  EXPECT_NEAR(out[2], 0.7, 1e-15);
  cut.setup.cut_direction = CutDirection::inward;
  EXPECT_EQ(height_um("hysteresis", cut, {0.1, 0.2, 0.4}), -out);
  const slideway::Setup inward = cut.setup;
  EXPECT_EQ(make("hysteresis")->lacking_together({&inward, &inward}).size(), 1U);
}

// Its slope over a base is that at the middle of the base, as of every parabola.
TEST(Hysteresis, OfSlopesIsThatOfItsHeights) {
  Case heights = face({0.0, 450.0, 550.0, 1000.0});
  heights.setup.kind = Kind::slide;
  heights.setup.cut_direction = CutDirection::inward;
  const Eigen::VectorXd z = height_um("hysteresis", heights, {0.1, 0.2, 0.4});
  Case slopes = heights;
  slopes.positions = {500.0, 1000.0};
  slopes.setup.quantity = Quantity::slope;
  slopes.setup.base_mm = 100.0;
  EXPECT_NEAR(height_um("hysteresis", slopes, {0.1, 0.2, 0.4})[0], (z[2] - z[1]) / 100.0, 1e-15);
}

TEST(Hysteresis, OfASlideGoesTheWayItsTimesSay) {
  Case there = face({0.0, 500.0, 1000.0});
  there.setup.kind = Kind::slide;
  there.setup.cut_direction.reset();
  const auto read_at = [&](std::vector<double> times_s) {
    Case out = there;
    out.setup.reading_times =
        std::make_shared<const ReadingTimes>(ReadingTimes{there.positions, std::move(times_s)});
    return out;
  };
  const Case back = read_at({60.0, 30.0, 0.0});
  const std::initializer_list<double> values{0.1, 0.2, 0.4};
  EXPECT_EQ(height_um("hysteresis", back, values),
            -height_um("hysteresis", read_at({0.0, 30.0, 60.0}), values));
  EXPECT_FALSE(make("hysteresis")->lacking(read_at({0.0, 60.0, 30.0}).setup).empty());
  there.setup.cut_direction = CutDirection::inward;
  EXPECT_EQ(height_um("hysteresis", back, values), height_um("hysteresis", there, values));
}

TEST(Hysteresis, TakesTwoFacesOfEachDirectionToBeToldAndOneReading) {
  Case inward = face({0.0, 5.0, 10.0}), outward = inward;
  inward.setup.cut_direction = CutDirection::inward;
  outward.setup.cut_direction = CutDirection::outward;
  const slideway::Setup &in = inward.setup, &out = outward.setup;
  const auto effect = make("hysteresis");
  EXPECT_TRUE(effect->lacking_together({&in, &in, &out}).empty());
  EXPECT_EQ(effect->lacking_to_be_told({&in, &in, &out}).size(), 1U);
  EXPECT_TRUE(effect->lacking_to_be_told({&in, &out, &in, &out}).empty());
  inward.setup.kind = outward.setup.kind = Kind::slide;
  EXPECT_TRUE(effect->lacking_to_be_told({&in, &out}).empty());
}

}  // namespace
}  // namespace slideway::placing_terms_test
