// The carriage model of Eqs. (10) to (16) against its algebra, worked out on paper.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/effect_cases.hpp"

namespace slideway::carriage_test {
namespace {

using namespace testing_support;

Case face(double spindle_position, double reach = 10.0) {
  Case profile{"face", setup_of(Kind::face, Quantity::height, 0, reach), spaced(0, reach, 41)};
  profile.setup.spindle_position_mm = spindle_position;
  profile.setup.cut_radius_mm = reach;
  return profile;
}

Eigen::VectorXd unit(Eigen::Index size, Eigen::Index at, double value = 1.0) {
  return Eigen::VectorXd::Unit(size, at) * value;
}

const TravelRange kShort{.slide_min = 0.0, .slide_max = 10.0, .z_min = 0.0, .z_max = 80.0};

TEST(Straightness, WithOneLeverXColumnOfBkIsOneMinusKTimesXToTheK) {
  // Eq. (16) with p_x = x: x^k - k x^(k-1) x = (1 - k) x^k; b_1 vanishes identically.
  const auto effect = make("straightness", kShort);
  const Case profile = face(0.0);
  for (Eigen::Index k = 0; k <= 5; ++k) {
    const Eigen::VectorXd z = signal(*effect, profile, unit(6, k));
    // 1e-13 of the largest power on [0, 10]: six Legendre terms of a few ulp each.
    const double tolerance = 1e-13 * std::pow(10.0, static_cast<double>(k));
    for (Eigen::Index i = 0; i < z.size(); ++i)
      EXPECT_NEAR(
          z[i],
          (1.0 - static_cast<double>(k)) * std::pow(profile.positions[i], static_cast<double>(k)),
          10.0 * tolerance)
          << k;
  }
}

TEST(Straightness, AnAffineLeverAddsOnePowerBelow) {
  // p_x = x - x_c: x^k - k x^(k-1) (x - x_c) = (1 - k) x^k + k x_c x^(k-1).
  const TravelRange travel{.slide_min = 30.0, .slide_max = 40.0, .z_min = 0.0, .z_max = 0.0};
  const auto effect = make("straightness", travel);
  const Case profile = face(30.0);
  for (int k = 0; k <= 5; ++k) {
    const Eigen::VectorXd z = signal(*effect, profile, unit(6, k));
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const double x = 30.0 + profile.positions[i];
      const double expected =
          (1 - k) * std::pow(x, k) + (k > 0 ? k * 30.0 * std::pow(x, k - 1) : 0.0);
      // The powers of 40 cancel each other's digits; their size sets the rounding.
      EXPECT_NEAR(z[i], expected, 1e-12 * std::pow(40.0, k)) << k;
    }
  }
}

TEST(Straightness, WithSplitLeverPitchActsOnTheOverhangOnly) {
  // x - overhang for b_1, x² - 2 x overhang for b_2 (overhang 25 mm in these cases).
  const auto effect = make("straightness", kShort, Lever::split, 2);
  const Case profile = face(0.0);
  const Eigen::VectorXd b1 = signal(*effect, profile, unit(3, 1), Lever::split);
  const Eigen::VectorXd b2 = signal(*effect, profile, unit(3, 2), Lever::split);
  for (Eigen::Index i = 0; i < b1.size(); ++i) {
    const double x = profile.positions[i];
    EXPECT_NEAR(b1[i], x - 25.0, 1e-13 * 25);
    EXPECT_NEAR(b2[i], x * x - 50.0 * x, 1e-13 * 500);
  }
}

TEST(Straightness, ConvertsLegendrePolynomialsToPowersExactly) {
  // Rodrigues: P_10(x) = (46189 x^10 - 109395 x^8 + 90090 x^6 - 30030 x^4 + 3465 x^2 - 63) / 256.
  const double p10[] = {-63, 0, 3465, 0, -30030, 0, 90090, 0, -109395, 0, 46189};
  const auto effect = make("straightness", {.slide_min = -1.0, .slide_max = 1.0}, Lever::paper, 10);
  const Eigen::VectorXd b = effect->parameter_values(unit(11, 10), {}).values;
  for (int k = 0; k <= 10; ++k) EXPECT_DOUBLE_EQ(b[k], p10[k] / 256.0) << k;
}

TEST(Straightness, ConvertsShiftedLegendrePolynomialsExactly) {
  // On [0, 1]: P_10 = Σ_k C(10, k) C(10 + k, k) (-x)^k, all integers.
  const double shifted[] = {1,       -110,     2970,    -34320,  210210, -756756,
                            1681680, -2333760, 1969110, -923780, 184756};
  const auto effect = make("straightness", {.slide_min = 0.0, .slide_max = 1.0}, Lever::paper, 10);
  const Eigen::VectorXd b = effect->parameter_values(unit(11, 10), {}).values;
  for (int k = 0; k <= 10; ++k) EXPECT_DOUBLE_EQ(b[k], shifted[k]) << k;
}

TEST(Straightness, RestoresPowersFarFromTheOrigin) {
  // Filip's interval and degree: 13 digits are wanted of the fit, the conversion must not cost any.
  const TravelRange travel{.slide_min = -8.781464495, .slide_max = -3.132002490};
  const auto effect = make("straightness", travel, Lever::paper, 10);
  Eigen::VectorXd b(11);
  // Certified coefficients of NIST StRD Filip.
  b << -1467.48961422980, -2772.17959193342, -2316.37108160893, -1127.97394098372,
      -354.478233703349, -75.1242017393757, -10.8753180355343, -1.06221498588947,
      -0.670191154593408e-1, -0.246781078275479e-2, -0.402962525080404e-4;
  const Eigen::VectorXd a = effect->from_parameters(b);
  const Eigen::VectorXd back = effect->parameter_values(a, {}).values;
  // The amplitudes are rounded to doubles on the way, and each b_k is a sum that cancels 2 digits.
  for (Eigen::Index k = 0; k <= 10; ++k) EXPECT_NEAR(back[k] / b[k], 1.0, 1e-13) << k;
}

TEST(VerticalStraightness, C1AndSquarenessAreOneColumnWithOneLever) {
  const auto vertical = make("vertical_straightness", kShort);
  const auto squareness = make("squareness", kShort);
  const Case profile = face(0.0);
  const Eigen::VectorXd c1 = signal(*vertical, profile, unit(5, 0));
  const Eigen::VectorXd dbeta = signal(*squareness, profile, unit(1, 0));
  EXPECT_LT((c1 - dbeta).norm(), 1e-14 * dbeta.norm());
}

TEST(VerticalStraightness, PitchIsTheDerivativeOfThePolynomial) {
  // Eq. (13): -Σ k c_k z^(k-1) p_x at z = 80 mm.
  const auto effect = make("vertical_straightness", kShort);
  const Case profile = face(0.0);
  for (int k = 1; k <= 5; ++k) {
    const Eigen::VectorXd z = signal(*effect, profile, unit(5, k - 1));
    const double expected = -k * std::pow(80.0, k - 1) * 10.0;
    EXPECT_NEAR(z[z.size() - 1], expected, 1e-14 * std::abs(expected));
  }
}

TEST(VerticalStraightness, ActsOnTheOverhangWithSplitLever) {
  const auto effect = make("vertical_straightness", kShort, Lever::split);
  const Eigen::VectorXd z = signal(*effect, face(0.0), unit(5, 0), Lever::split);
  for (Eigen::Index i = 0; i < z.size(); ++i) EXPECT_DOUBLE_EQ(z[i], -25.0);
}

TEST(Squareness, MakesThePapersAmplitudeOverTheTravel) {
  // 2.8e-6 rad x 600 mm = 1.68 µm (the paper rounds to 1.7 µm); a cone on a full diameter.
  const auto effect = make("squareness");
  for (const Lever lever : {Lever::paper, Lever::split}) {
    const Eigen::VectorXd z = signal(*effect, face(0.0, 600.0), unit(1, 0, 2.8e-6), lever);
    EXPECT_NEAR(z[40], -1.68e-3, 1e-15);
    EXPECT_EQ(z[0], 0.0);
  }
  const Case diameter = all_cases()[2];
  const Eigen::VectorXd cone = signal(*effect, diameter, unit(1, 0));
  EXPECT_DOUBLE_EQ(cone[0], -10.0);
  EXPECT_DOUBLE_EQ(cone[52], -10.0);
}

TEST(GantrySag, PitchesByHalfTheSlopeOfItsLocus) {
  // Maxwell and Betti: the beam under a travelling load has half the slope of the locus.
  const auto effect = make("gantry_sag");
  Case height{"height", setup_of(Kind::slide, Quantity::height, 0, 700), spaced(0, 700, 71)};
  Case slope = height;
  slope.setup.quantity = Quantity::slope;
  const Eigen::VectorXd pitch = signal(*effect, slope, unit(1, 0));
  Case behind = height, ahead = height;
  for (double& x : behind.positions) x -= 0.01;
  for (double& x : ahead.positions) x += 0.01;
  const Eigen::VectorXd locus_slope =
      (signal(*effect, ahead, unit(1, 0)) - signal(*effect, behind, unit(1, 0))) / 0.02;
  // The ends have a kink in curvature: leave them out; elsewhere the difference is of order step².
  for (Eigen::Index i = 1; i < 70; ++i) EXPECT_NEAR(pitch[i], locus_slope[i] / 2.0, 1e-13);
  EXPECT_NEAR(signal(*effect, height, unit(1, 0))[35], 1e-3, 1e-18);  // 1 µm at mid-span
}

TEST(GantrySag, FaceSeesLocusMinusHalfTheSlopeTimesTheLever) {
  // With p_x = x the sag term s x^4 alone would give (1 - 4/2) s x^4; here the whole polynomial.
  const auto effect = make("gantry_sag");
  const Case profile = face(0.0, 300.0);
  const Eigen::VectorXd z = signal(*effect, profile, unit(1, 0));
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const double x = profile.positions[i], l = 700.0;
    // 16 (x² L² - 2 x³ L + x⁴)/L⁴ with the factors 1 - k/2 for k = 2, 3, 4.
    const double expected =
        16e-3 * (2 * 0.5 * std::pow(x, 3) * l - std::pow(x, 4)) / std::pow(l, 4);
    EXPECT_NEAR(z[i], expected, 1e-17) << x;
  }
}

TEST(GantrySag, IsNothingOutsideTheSpan) {
  const auto effect = make("gantry_sag");
  const Case profile{
      "", setup_of(Kind::slide, Quantity::height, -100, 800), {-100.0, 0.0, 700.0, 800.0}};
  EXPECT_TRUE(signal(*effect, profile, unit(1, 0)).isZero(0.0));
}

}  // namespace
}  // namespace slideway::carriage_test
