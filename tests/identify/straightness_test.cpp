#include "slideway/identify/straightness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/budget.hpp"
#include "slideway/identify/reference_line.hpp"

namespace slideway {
namespace {

// y = x² on [0, 1]: the end-point and the minimum-zone line have slope 1 and a strip of 1/4
// (deviation x² - x, least at 1/2); the least-squares line is x - 1/6.
class Parabola : public testing::Test {
 protected:
  Parabola()
      : x_(Eigen::VectorXd::LinSpaced(1001, 0.0, 1.0)),
        lines_(reference_lines(x_, x_.array().square())) {}
  [[nodiscard]] Eigen::Vector2d least_squares() const {
    return lines_[1].of_heights * x_.array().square().matrix();
  }
  Eigen::VectorXd x_;
  std::vector<ReferenceLine> lines_;
};

TEST_F(Parabola, HasTheErrorsOfItsThreeLines) {
  ASSERT_EQ(lines_.size(), 3U);
  EXPECT_EQ(lines_[0].kind, ReferenceLineKind::end_point);
  EXPECT_NEAR(lines_[0].error, 0.25, 1e-12);
  EXPECT_NEAR(lines_[0].highest, 0.0, 1e-12);
  EXPECT_NEAR(lines_[0].lowest, -0.25, 1e-12);
  EXPECT_EQ(lines_[0].lowest_at, 500U);
  EXPECT_EQ(lines_[1].kind, ReferenceLineKind::least_squares);
  EXPECT_NEAR(least_squares()[1], 1.0, 1e-9);
  EXPECT_NEAR(least_squares()[0], -1.0 / 6.0, 1e-3);  // of 1001 points, not of the integral
  EXPECT_EQ(lines_[2].kind, ReferenceLineKind::minimum_zone);
  EXPECT_NEAR(lines_[2].error, 0.25, 1e-12);
  EXPECT_NEAR(lines_[2].highest, 0.125, 1e-12);
  EXPECT_NEAR(lines_[2].lowest, -0.125, 1e-12);
}

// Of a cube: no two points are equally far out.
TEST(ReferenceLines, DeviationsAreTheDerivativesOfTheError) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(1001, 0.0, 1.0), z = x.array().cube();
  Eigen::VectorXd bent = z;
  for (Eigen::Index i = 0; i < bent.size(); ++i) bent[i] += 1e-9 * std::sin(7.0 * x[i]);
  const std::vector<ReferenceLine> lines = reference_lines(x, z), moved = reference_lines(x, bent);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Eigen::VectorXd change = lines[l].deviations(x, bent - z);
    EXPECT_NEAR(change[static_cast<Eigen::Index>(lines[l].highest_at)] -
                    change[static_cast<Eigen::Index>(lines[l].lowest_at)],
                moved[l].error - lines[l].error, 1e-14)
        << text_of(lines[l].kind);
  }
}

TEST(ReferenceLines, OfAStraightLineLeaveNothing) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(11, -5.0, 5.0);
  const Eigen::VectorXd z = 2.0 * x.array() + 1.0;
  for (const ReferenceLine& line : reference_lines(x, z)) {
    EXPECT_NEAR(line.error, 0.0, 1e-12) << text_of(line.kind);
    EXPECT_NEAR((line.of_heights * z)[1], 2.0, 1e-12) << text_of(line.kind);
  }
}

// No line has a narrower strip than the minimum zone's; ISO 230-1:2012, 3.4.
TEST(ReferenceLines, MinimumZoneIsTheNarrowest) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(101, 0.0, 10.0);
  const Eigen::VectorXd z =
      x.unaryExpr([](double v) { return std::sin(v) + 0.3 * std::cos(3.1 * v); });
  const std::vector<ReferenceLine> lines = reference_lines(x, z);
  EXPECT_LE(lines[2].error, lines[0].error);
  EXPECT_LE(lines[2].error, lines[1].error);
  for (double slope = -1.0; slope <= 1.0; slope += 1e-3) {
    const Eigen::VectorXd rest = z - slope * x;
    EXPECT_GE(rest.maxCoeff() - rest.minCoeff(), lines[2].error - 1e-12);
  }
}

/// A reading along 200 mm of a slide that is a parabola of 4 µm, two runs with noise of 10 nm.
std::vector<Profile> parabolic_slide() {
  std::vector<Profile> runs;
  for (const std::string name : {"first", "second"}) {
    RandomStream noise(1, name);
    const std::vector<double> x = cases::spaced(0.0, 200.0, 400);
    std::vector<double> z;
    for (const double at : x) z.push_back(4e-3 * std::pow(at / 200.0, 2) + 1e-5 * noise.normal());
    runs.push_back(cases::profile(name, Kind::slide, x, z));
  }
  return runs;
}

TEST(IdentifiedStraightness, IsThatOfTheSlideWithinItsUncertainty) {
  const std::vector<Profile> runs = parabolic_slide();
  const Model model =
      build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 3)}), runs);
  const auto found = identified_straightness(model, fit(model));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->errors.size(), 3U) << found->reason;
  for (const auto& error : found->errors) {
    if (error.line == ReferenceLineKind::least_squares) continue;
    EXPECT_NEAR(*error.value, 1.0, 2.0 * *error.expanded_uncertainty) << text_of(error.line);
    EXPECT_LT(*error.expanded_uncertainty, 0.02) << text_of(error.line);
    EXPECT_GT(*error.expanded_uncertainty, 0.0) << text_of(error.line);
  }
  EXPECT_NEAR(found->errors[0].lowest_at_mm, 100.0, 5.0);
}

// Of 2 s² - 1.2 s³ µm the least-squares line leaves its lowest point within, at an end nearly as
// low a one: noise chooses which of them the error rests on. On a face b_k of the carriage gives
// (1 - k) b_k r^k, and squareness has a column beside it: the end is known ten times as well. With
// the U of the pair that was chosen 71.5 % of 1000 readings held the error.
TEST(IdentifiedStraightness, HoldsTheErrorWhereTwoPairsOfPointsAreNearlyAsFarApart) {
  const std::vector<double> r = cases::spaced(0.0, 200.0, 100);
  const auto form = [](double at) {
    const double s = at / 200.0;
    return 1e-3 * (2.0 * s * s - 1.2 * s * s * s);
  };
  const auto on_face = [](double at) {
    const double s = at / 200.0;
    return 1e-3 * (-2.0 * s * s + 2.0 * 1.2 * s * s * s);
  };
  const Eigen::VectorXd fine = Eigen::VectorXd::LinSpaced(2001, 0.0, 200.0);
  const double truth = least_squares_line(fine, fine.unaryExpr(form)).error / kMicrometre;
  int held = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomStream noise(seed, "radius");
    std::vector<double> z;
    for (const double at : r) z.push_back(on_face(at) + 2e-5 * noise.normal());
    const std::vector<Profile> face{cases::profile("radius", Kind::face, r, z)};
    const Model model =
        build_model(cases::problem(Lever::paper, 0,
                                   {cases::effect("straightness", 3), cases::effect("squareness")}),
                    face);
    const auto found = identified_straightness(model, fit(model));
    ASSERT_TRUE(found);
    const auto error = std::ranges::find(found->errors, ReferenceLineKind::least_squares,
                                         &StraightnessError::line);
    ASSERT_NE(error, found->errors.end()) << found->reason;
    held += std::abs(*error->value - truth) <= *error->expanded_uncertainty ? 1 : 0;
  }
  EXPECT_GE(held, 35);  // of 40 at 95.45 %: fewer in 1 %; at 71.5 %, in 98 %
}

// Both runs read the same 400 places: 50 of them, once, from end to end; 4 (s² - s) µm from the
// line.
TEST(IdentifiedStraightness, IsGivenAtTheStationsOfTheReadings) {
  const std::vector<Profile> runs = parabolic_slide();
  const Model model =
      build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 3)}), runs);
  const auto found = identified_straightness(model, fit(model));
  ASSERT_TRUE(found);
  ASSERT_EQ(found->stations.size(), 50U);
  EXPECT_EQ(found->stations.front().position_mm, 0.0);
  EXPECT_EQ(found->stations.back().position_mm, 200.0);
  for (std::size_t i = 0; i < 50; ++i) {
    const StraightnessStation& station = found->stations[i];
    const double s = station.position_mm / 200.0;
    EXPECT_NEAR(s, static_cast<double>(i) / 49.0, 1.0 / 399.0);
    EXPECT_NEAR(station.deviation_um, 4.0 * (s * s - s), 2.0 * *station.expanded_uncertainty_um);
  }
}

/// A way with a bow of 5 µm and a worn place 20 µm deep, mm.
double worn_way(double x) {
  const double s = x / 800.0;
  return 20e-3 * s * (s - 1.0) - 20e-3 * std::exp(-0.5 * std::pow((x - 450.0) / 70.0, 2));
}

Straightness of_worn_way(const std::vector<std::string>& shown_by) {
  std::vector<Profile> runs;
  for (const char* name : {"run1", "run2"}) {
    RandomStream noise(3, name);
    const std::vector<double> x = cases::spaced(0.0, 800.0, 41);
    std::vector<double> z;
    for (const double at : x) z.push_back(worn_way(at) + 1e-4 * noise.normal());
    runs.push_back(cases::profile(name, Kind::slide, x, z));
  }
  DeclaredEffect form = cases::effect("local_form");
  form.options.profiles = shown_by;
  const Model model =
      build_model(cases::problem(Lever::paper, 0, {cases::effect("straightness", 3), form}), runs);
  return identified_straightness(model, fit(model)).value();
}

// E_ZX is the form of the way, under how many names the model has it.
TEST(IdentifiedStraightness, HoldsALocalFormThatEveryReadingShows) {
  double low = 0.0;
  for (double x = 0.0; x <= 800.0; x += 0.5)
    low = std::min(low,
                   worn_way(x) - worn_way(0.0) * (1.0 - x / 800.0) - worn_way(800.0) * x / 800.0);
  const Straightness found = of_worn_way({});
  EXPECT_EQ(found.parts, std::vector<std::string>{"local_form"});
  // At U a seed in 22 is outside; at 2 U one in 10⁴.
  EXPECT_NEAR(*found.end_point_um, -low / kMicrometre, 2.0 * *found.expanded_uncertainty_um);
  EXPECT_LT(*found.expanded_uncertainty_um, 0.5);
  for (const StraightnessStation& station : found.stations)
    EXPECT_NEAR(
        station.deviation_um,
        (worn_way(station.position_mm) - worn_way(0.0) * (1.0 - station.position_mm / 800.0) -
         worn_way(800.0) * station.position_mm / 800.0) /
            kMicrometre,
        2.0 * *station.expanded_uncertainty_um + 1e-9);
  EXPECT_TRUE(of_worn_way({"run1"}).parts.empty());
}

TEST(IdentifiedStraightness, IsNotGivenWhereTheDataDoNotTellIt) {
  // One lever and one face: b_2 x² and the cup are one column.
  const std::vector<Profile> faces{
      cases::face("face", 2.0, cases::spaced(0.0, 10.0, 400), parabolic_slide().front().values)};
  const Model model = build_model(
      cases::problem(Lever::paper, 0, {cases::effect("straightness", 2), cases::effect("cup")}),
      faces);
  const auto found = identified_straightness(model, fit(model));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->errors.empty());
  EXPECT_NE(found->reason, "");
}

/// A face of 100 mm that a slide bent by 2.6 µm has made: b_2 = 4 · 2.6 µm / (100 mm)².
ModelResult bent_by_more_than_most(double noise_um) {
  RandomStream noise(5, "bent");
  const std::vector<double> x = cases::spaced(0.0, 100.0, 200);
  std::vector<double> z;
  for (const double each : x)
    z.push_back(kMicrometre * (4.0 * 2.6e-4 * each * each + noise_um * noise.normal()));
  const std::vector<Profile> faces{cases::face("face", 2.0, x, z)};
  const Problem problem = cases::problem(Lever::paper, 0, {cases::effect("straightness", 2)});
  const FittedModel fitted = fit_declared(problem, faces);
  return summarise(fitted.model, fitted.fit);
}

// 10 µm over 200 mm are 10 µm (1/2)² = 2.5 µm over 100 mm.
TEST(PlausibleStraightness, IsExceededByMoreThanItsUncertainty) {
  const ModelResult certain = bent_by_more_than_most(0.02), uncertain = bent_by_more_than_most(0.8);
  EXPECT_NE(certain.implausible, "");
  ASSERT_GT(*uncertain.straightness->least_squares_um, 2.5);
  EXPECT_EQ(uncertain.implausible, "");
}

TEST(UncertaintyBudget, AddsUpToTheUncertaintyOfEachParameter) {
  const std::vector<Profile> runs = parabolic_slide();
  DeclaredEffect straightness = cases::effect("straightness", 3);
  straightness.priors = {{"b2", 1e-7, 1e-9}};
  const Model model = build_model(cases::problem(Lever::paper, 0, {straightness}), runs);
  const Solution fitted = fit(model);
  const ModelResult numbers = summarise(model, fitted);
  const std::vector<Budget> budgets = uncertainty_budget(model, fitted);
  ASSERT_FALSE(budgets.empty());
  for (const Budget& budget : budgets) {
    ASSERT_EQ(budget.lines.size(), 4U);  // two runs, the prior, the weights
    double variance = 0.0;
    for (const BudgetLine& line : budget.lines)
      variance += line.standard_uncertainty * line.standard_uncertainty;
    EXPECT_NEAR(std::sqrt(variance) / *numbers.find(budget.parameter)->standard_uncertainty, 1.0,
                1e-9)
        << budget.parameter;
  }
}

}  // namespace
}  // namespace slideway
