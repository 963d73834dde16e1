// Straightness as a curve: what its columns are, from the mathematics of B-splines and Eq. (12).

#include <gtest/gtest.h>

#include <cmath>

#include "effects/effect_cases.hpp"
#include "slideway/base/error.hpp"

namespace slideway::curve_test {
namespace {

using namespace testing_support;  // NOLINT(google-build-using-namespace)

std::unique_ptr<Effect> curve(double resolution, const TravelRange& travel = kTravel) {
  return make_effect("straightness", {.form = Form::curve, .resolution_mm = resolution}, lathe(),
                     travel);
}

/// A smooth form: amplitudes of the knots are those of a sine.
Eigen::VectorXd wave(const Effect& effect) {
  const Knots knots = *effect.knots();
  Eigen::VectorXd out = Eigen::VectorXd::Zero(effect.amplitudes());
  out.tail(knots.positions_mm.size()) = (knots.positions_mm.array() / 70.0).sin();
  return out;
}

Eigen::VectorXd along(const Effect& effect, const Eigen::VectorXd& x, Quantity quantity) {
  return along_slide(effect, lathe(), x, quantity) * wave(effect);
}

// Marsden's identity: cubic B-splines with coefficients on a line are that line.
TEST(Curve, OfKnotsOnALineIsThatLine) {
  const auto effect = curve(25.0);
  const Knots knots = *effect->knots();
  Eigen::VectorXd amplitudes = Eigen::VectorXd::Zero(effect->amplitudes());
  amplitudes.tail(knots.positions_mm.size()) = 0.5 * knots.positions_mm.array() - 3.0;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(101, 0.0, 600.0);
  const Eigen::VectorXd z = along_slide(*effect, lathe(), x, Quantity::height) * amplitudes;
  EXPECT_LT((z - (0.5 * x.array() - 3.0).matrix()).cwiseAbs().maxCoeff(), 1e-11);  // of 300
}

TEST(Curve, HasKnotsAsFarApartAsItsResolution) {
  const Knots knots = *curve(25.0)->knots();
  ASSERT_EQ(knots.positions_mm.size(), 600 / 25 + 3);
  EXPECT_DOUBLE_EQ(knots.positions_mm[1], 0.0);
  EXPECT_DOUBLE_EQ(knots.positions_mm[2], 25.0);
  EXPECT_LE(curve(0.01)->knots()->positions_mm.size(), 120);
}

// Central differences of a cubic: the error is step² / 6 of the third derivative, here 1 / 70³.
TEST(Curve, SlopeIsTheDerivativeOfItsHeight) {
  const auto effect = curve(25.0);
  const double step = 1e-3;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(97, 1.0, 599.0);
  const Eigen::VectorXd ahead = x.array() + step, behind = x.array() - step;
  const Eigen::VectorXd slope = along(*effect, x, Quantity::slope);
  const Eigen::VectorXd difference =
      (along(*effect, ahead, Quantity::height) - along(*effect, behind, Quantity::height)) /
      (2.0 * step);
  EXPECT_LT((slope - difference).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Curve, OfABridgeIsTheMeanSlopeOverItsBase) {
  const auto effect = curve(25.0);
  Case bridge{"bridge", setup_of(Kind::slide, Quantity::slope, 50, 550), spaced(50, 550, 51)};
  bridge.setup.base_mm = 40.0;
  const Eigen::Map<const Eigen::ArrayXd> x(bridge.positions.data(), 51);
  const Eigen::VectorXd read = columns(*effect, bridge) * wave(*effect);
  const Eigen::VectorXd mean = (along(*effect, (x + 20.0).matrix(), Quantity::height) -
                                along(*effect, (x - 20.0).matrix(), Quantity::height)) /
                               40.0;
  EXPECT_LT((read - mean).cwiseAbs().maxCoeff(), 1e-14);  // rounding of heights of 1 over 40
}

// Eq. (12) with p_x = r: f(x) - r f'(x).
TEST(Curve, PitchesTheToolByItsSlopeOnTheLever) {
  const TravelRange travel{.slide_min = 360.0, .slide_max = 370.0};
  const auto effect = curve(0.5, travel);
  const Case face{"face", setup_of(Kind::face, Quantity::height, 0, 10), spaced(0, 10, 53)};
  const Eigen::Map<const Eigen::VectorXd> r(face.positions.data(), 53);
  const Eigen::VectorXd x = 360.0 + r.array();
  const Eigen::VectorXd expected =
      along(*effect, x, Quantity::height) - r.cwiseProduct(along(*effect, x, Quantity::slope));
  const Eigen::VectorXd read = columns(*effect, face) * wave(*effect);
  EXPECT_LT((read - expected).cwiseAbs().maxCoeff(), 1e-12);  // rounding
}

TEST(Curve, HasOffsetAndSlopeForParametersAndNoOthers) {
  const auto effect = curve(25.0);
  ASSERT_EQ(effect->parameters().size(), 2U);
  for (const Parameter& parameter : effect->parameters()) EXPECT_TRUE(parameter.by_convention);
  const Eigen::Vector2d values(0.25, -3.0);
  const ParameterValues back = effect->parameter_values(effect->from_parameters(values), {});
  EXPECT_EQ(back.values, values);
}

TEST(Curve, TakesNoDegreeAndAPolynomialNoResolution) {
  EXPECT_THROW(make_effect("straightness", {.degree = 3, .form = Form::curve}, lathe(), kTravel),
               UsageError);
  EXPECT_THROW(make_effect("straightness", {.degree = 3, .resolution_mm = 1.0}, lathe(), kTravel),
               UsageError);
  EXPECT_THROW(make_effect("squareness", {.form = Form::curve}, lathe(), kTravel), UsageError);
}

}  // namespace
}  // namespace slideway::curve_test
