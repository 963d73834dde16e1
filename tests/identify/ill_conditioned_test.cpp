// Polynomials that cost a fit its digits, against normal equations with a hundred of them.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <vector>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/identify/identifiability.hpp"

namespace slideway::ill_conditioned_test {
namespace {

using Exact = boost::multiprecision::cpp_bin_float_100;

constexpr std::size_t kStations = 400;
constexpr double kNoise = 0.01;  // of the amplitude

struct Readings {
  double first_mm, last_mm;
  int degree;
  double amplitude_mm;
};

/// A slide read in heights: a form of that degree with coefficients of one size in (x - middle) /
/// half length, and white noise of a declared size.
Profile profile_of(const Readings& readings, std::uint64_t seed) {
  RandomStream random(seed, "form");
  std::vector<double> coefficients, values;
  for (int k = 0; k <= readings.degree; ++k) coefficients.push_back(random.normal());
  const std::vector<double> x = cases::spaced(readings.first_mm, readings.last_mm, kStations);
  for (const double at : x) {
    const double u =
        (2.0 * at - readings.first_mm - readings.last_mm) / (readings.last_mm - readings.first_mm);
    double form = 0.0;
    for (int k = readings.degree; k >= 0; --k)
      form = form * u + coefficients[static_cast<std::size_t>(k)];
    values.push_back(readings.amplitude_mm * (form + kNoise * random.normal()));
  }
  Profile out = cases::profile("way", Kind::slide, x, values);
  out.free_offset = out.free_tilt = false;
  out.standard_uncertainty = kNoise * readings.amplitude_mm;
  return out;
}

struct Coefficient {
  double value, standard_uncertainty;
};

/// b_0, b_1, ... and their uncertainties: the normal equations of the powers of x, eliminated after
/// Gauss and Jordan. Their condition of up to 1e90 costs as many of the hundred digits.
std::vector<Coefficient> exact(const Profile& profile, int degree) {
  const auto n = static_cast<std::size_t>(degree) + 1;
  std::vector<std::vector<Exact>> a(n, std::vector<Exact>(2 * n + 1));
  for (std::size_t i = 0; i < profile.positions.size(); ++i) {
    std::vector<Exact> powers{1};
    while (powers.size() < 2 * n) powers.push_back(powers.back() * Exact(profile.positions[i]));
    for (std::size_t row = 0; row < n; ++row) {
      for (std::size_t column = 0; column < n; ++column) a[row][column] += powers[row + column];
      a[row][2 * n] += powers[row] * Exact(profile.values[i]);
    }
  }
  for (std::size_t row = 0; row < n; ++row) a[row][n + row] = 1;
  for (std::size_t pivot = 0; pivot < n; ++pivot) {
    const Exact own = a[pivot][pivot];  // of a definite matrix: above 0
    for (Exact& each : a[pivot]) each /= own;
    for (std::size_t row = 0; row < n; ++row) {
      if (row == pivot) continue;
      const Exact factor = a[row][pivot];
      for (std::size_t column = 0; column <= 2 * n; ++column)
        a[row][column] -= factor * a[pivot][column];
    }
  }
  std::vector<Coefficient> out;
  for (std::size_t k = 0; k < n; ++k)
    out.push_back({static_cast<double>(a[k][2 * n]),
                   *profile.standard_uncertainty * static_cast<double>(sqrt(a[k][n + k]))});
  return out;
}

ModelResult fitted(const Profile& profile, int degree) {
  const std::vector<Profile> profiles{profile};
  const Problem problem = cases::problem(Lever::paper, 0, {cases::effect("straightness", degree)});
  const Model model = build_model(problem, profiles);
  return summarise(model, fit(model));
}

std::vector<Coefficient> found(const Profile& profile, int degree) {
  const ModelResult result = fitted(profile, degree);
  std::vector<Coefficient> out;
  for (int k = 0; k <= degree; ++k) {
    const FittedParameter* b = result.find("straightness.b" + std::to_string(k));
    EXPECT_TRUE(b && b->value && b->standard_uncertainty) << "b_" << k;
    if (!b || !b->value || !b->standard_uncertainty) return {};
    out.push_back({*b->value, *b->standard_uncertainty});
  }
  return out;
}

/// A thousandth of the standard uncertainty is more than a reader of the report can see.
constexpr double kOfUncertainty = 1e-3;
constexpr double kRelative = 1e-6;  // of an uncertainty: no rounding shows in its digits

void expect_exact(const Readings& readings) {
  const Profile profile = profile_of(readings, 5);
  const std::vector<Coefficient> expected = exact(profile, readings.degree);
  const std::vector<Coefficient> own = found(profile, readings.degree);
  ASSERT_EQ(own.size(), expected.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    EXPECT_NEAR(own[k].value, expected[k].value, kOfUncertainty * expected[k].standard_uncertainty)
        << "b_" << k;
    EXPECT_NEAR(own[k].standard_uncertainty / expected[k].standard_uncertainty, 1.0, kRelative)
        << "b_" << k;
  }
}

TEST(IllConditioned, ADegreeOf12IsThatOfAHundredDigits) { expect_exact({0.0, 600.0, 12, 1e-3}); }

// 0.6 mm at 400 mm of a travel of 600 mm.
TEST(IllConditioned, AThousandthOfTheTravelFarFromItsZeroIsThatOfAHundredDigits) {
  for (const int degree : {3, 6, 12}) {
    SCOPED_TRACE(degree);
    expect_exact({400.0, 400.6, degree, 1e-3});
  }
}

TEST(IllConditioned, HeightsFromAFemtometreToAKilometreAreThoseOfAHundredDigits) {
  for (const double amplitude_um : {1e-9, 1e-3, 1e3, 1e9}) {
    SCOPED_TRACE(amplitude_um);
    expect_exact({0.0, 600.0, 12, 1e-3 * amplitude_um});
  }
}

// Beside a slide of 2000 mm, heights of a face of 40 mm tell its own polynomial of degree 8 by
// columns that differ by 1e-12 of their size. What they leave open is in b_7 and b_8, too: these
// were -1e-16 mm⁻⁷ to 2 % where a hundred digits give 1e-11, known to its own size.
TEST(IllConditioned, WhatANearlyNullDirectionMovesIsNotDetermined) {
  const Rank rank = analyse_rank((Eigen::MatrixXd(2, 2) << 1.0, 1.0, 0.0, 1e-10).finished(),
                                 Eigen::Vector2d(1.0, 1.0), 1e-9);
  ASSERT_EQ(rank.basis.cols(), 1);
  ASSERT_EQ(rank.nearly_null.cols(), 1);
  // Singular values of the matrix: √2 and 1e-10/√2. Uncertainty of each: 1e10/√2 · √2.
  EXPECT_NEAR(rank.nearly_null.col(0).cwiseAbs().maxCoeff() / 1e10, 1.0, 1e-6);
  EXPECT_EQ(analyse_rank((Eigen::MatrixXd(2, 2) << 1.0, 1.0, 0.0, 1e-14).finished(),
                         Eigen::Vector2d(1.0, 1.0), 1e-9)
                .nearly_null.cols(),
            0);
}

TEST(IllConditioned, AFaceBesideALongSlideSaysWhatItDoesNotKnow) {
  RandomStream random(5514, "face");
  std::vector<Profile> profiles{profile_of({-1500.0, 2000.0, 3, 1e-2}, 3)};
  std::vector<double> heights;
  const std::vector<double> radii = cases::spaced(0.0, 40.0, 64);
  for ([[maybe_unused]] const double r : radii) heights.push_back(0.1 * random.normal());
  profiles.push_back(cases::face("face", 100.0, radii, heights));
  profiles.back().free_offset = false;
  profiles.back().standard_uncertainty = 0.1;
  profiles.back().setup.spindle_position_mm = -388.0;
  Problem problem = cases::problem(
      Lever::paper, 0, {cases::effect("straightness", 3), cases::effect("straightness", 8)});
  problem.effects[0].options.profiles = {"way"};
  problem.effects[1].options.profiles = {"face"};
  const Model model = build_model(problem, profiles);
  const ModelResult result = summarise(model, fit(model));
  for (const FittedParameter& each : result.parameters) {
    if (!each.name.starts_with("straightness[face]")) continue;
    EXPECT_FALSE(each.identifiable) << each.name;
    EXPECT_FALSE(each.value) << each.name;
  }
}

// Read from the other end, x becomes -x and b_k (-1)^k b_k; in units 25.4 times as small, x becomes
// 25.4 x and b_k b_k / 25.4^k.
TEST(IllConditioned, ADegreeOf12DoesNotMindReversalNorUnit) {
  constexpr int kDegree = 12;
  constexpr double kInch = 25.4;
  const Profile profile = profile_of({100.0, 500.0, kDegree, 1e-3}, 7);
  const std::vector<Coefficient> before = found(profile, kDegree);
  const auto expect = [&](double factor) {
    Profile other = profile;
    for (double& x : other.positions) x *= factor;
    if (factor < 0.0) {
      std::ranges::reverse(other.positions);
      std::ranges::reverse(other.values);
    }
    other.setup.first_mm = other.positions.front();
    other.setup.last_mm = other.positions.back();
    const std::vector<Coefficient> after = found(other, kDegree);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t k = 0; k < after.size(); ++k)
      EXPECT_NEAR(after[k].value * std::pow(factor, k), before[k].value,
                  kOfUncertainty * before[k].standard_uncertainty)
          << factor << ", b_" << k;
  };
  expect(-1.0);
  expect(kInch);
  expect(1.0 / kInch);
}

}  // namespace
}  // namespace slideway::ill_conditioned_test
