// What faces and slide readings determine of the carriage model, counted on paper.
#include "slideway/identify/identifiability.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <set>

#include "identify/cases.hpp"
#include "slideway/base/random.hpp"
#include "support/turning.hpp"

namespace slideway {
namespace {

constexpr double kTolerance = 1e-9;  // of a unit column, far above rounding

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

const turning::Carriage kLathe{
    .b = {0.0, 0.0, 2e-8, -1e-10}, .c = {0.0, 1e-5, 2e-7, -1e-9}, .squareness = 2e-5};

/// A face of that machine at height z; the trace runs from `first` mm (a radius from 0, a diameter
/// from -50) to 50 mm.
Profile face(double z_mm, double first_mm = 0.0) {
  turning::Carriage carriage = kLathe;
  carriage.z_mm = z_mm;
  turning::Cut cut;
  cut.radius_mm = 50.0;
  cut.feed_mm_per_min = 10.0;
  cut.spindle_rpm = 1000.0;
  turning::Stylus stylus;
  stylus.noise.white = 1e-5;
  const turning::Face surface(
      cut, [&](const turning::ToolPoint& tool) { return turning::one_lever(carriage, tool); });
  const std::string name = "level " + std::to_string(static_cast<int>(z_mm));
  RandomStream random(5, name);
  const std::vector<double> positions = cases::spaced(first_mm, 50.0, 1600);
  Profile out =
      cases::face(name, 10.0, positions, turning::trace(surface, positions, stylus, random));
  out.setup.z_mm = z_mm;
  return out;
}

struct Found {
  ModelResult result;
  std::set<std::string> undetermined;
  double largest_shift = 0.0;  // relative_shift() of all null directions

  explicit Found(std::vector<DeclaredEffect> effects, const std::vector<Profile>& profiles,
                 Lever lever = Lever::paper) {
    const Model model = build_model(cases::problem(lever, 3, std::move(effects)), profiles);
    const Solution fitted = fit(model);
    result = summarise(model, fitted);
    for (const FittedParameter& parameter : result.parameters) {
      if (!parameter.identifiable) undetermined.insert(parameter.name);
      EXPECT_EQ(parameter.value.has_value(), parameter.identifiable) << parameter.name;
      EXPECT_EQ(parameter.standard_uncertainty.has_value(), parameter.identifiable);
    }
    for (Eigen::Index d = 0; d < fitted.null.amplitudes.cols(); ++d)
      largest_shift =
          std::max(largest_shift, relative_shift(fitted.linear, fitted.null.amplitudes.col(d)));
  }

  [[nodiscard]] std::size_t nullity() const {
    return result.identifiability.parameters - result.identifiability.rank;
  }

 private:
  /// What moving along a null direction leaves in the profiles once their nuisances are refitted,
  /// beside the largest single term of it.
  static double relative_shift(const Linearisation& linear, const Eigen::VectorXd& direction) {
    double left = 0.0, terms = 0.0;
    for (std::size_t i = 0; i < linear.observations.size(); ++i) {
      const Eigen::MatrixXd& nuisances = linear.observations[i]->nuisances;
      Eigen::VectorXd shift = linear.columns[i] * direction;
      if (nuisances.cols() > 0) shift -= nuisances * nuisances.colPivHouseholderQr().solve(shift);
      left = std::max(left, shift.cwiseAbs().maxCoeff());
      terms = std::max(terms, (linear.columns[i] * direction.asDiagonal()).cwiseAbs().maxCoeff());
    }
    return left / terms;
  }
};

/// Rank is decided at 1e-9 of a column; what passes as null moves no prediction by more.
constexpr double kNothing = 1e-9;

std::vector<DeclaredEffect> carriage(int degree, int vertical_degree) {
  std::vector<DeclaredEffect> out{cases::effect("straightness", degree),
                                  cases::effect("squareness")};
  if (vertical_degree > 0) out.push_back(cases::effect("vertical_straightness", vertical_degree));
  return out;
}

std::set<std::string> names(const Combination& combination) {
  std::set<std::string> out;
  for (const auto& [name, coefficient] : combination) out.insert(name);
  return out;
}

TEST(Identifiability, OfOneRadiusLeavesTheGaugeAndEveryZTermButTheirSum) {
  // K + M + 2 columns, rank K + 1 with an offset in b_0 that the trace's own offset swallows.
  const Found found(carriage(3, 2), {face(40.0)});
  EXPECT_EQ(found.result.identifiability.parameters, 7u);
  EXPECT_EQ(found.nullity(), 4u);
  EXPECT_THAT(found.undetermined,
              UnorderedElementsAre("straightness.b0", "straightness.b1", "squareness.dbeta_xz",
                                   "vertical_straightness.c1", "vertical_straightness.c2"));
  EXPECT_LT(found.largest_shift, kNothing);
}

TEST(Identifiability, WithOneLeverB1AloneIsANullDirection) {
  const Found found(carriage(3, 0), {face(0.0)});
  EXPECT_THAT(found.undetermined, UnorderedElementsAre("straightness.b0", "straightness.b1"));
  std::vector<std::set<std::string>> directions;
  for (const UndeterminedDirection& direction : found.result.identifiability.unidentifiable)
    directions.push_back(names(direction.combination));
  EXPECT_THAT(directions, UnorderedElementsAre(std::set<std::string>{"straightness.b0"},
                                               std::set<std::string>{"straightness.b1"}));
  EXPECT_LT(found.largest_shift, kNothing);
}

TEST(Identifiability, OfC1AndTheSquarenessIsOneColumn) {
  const Found found(carriage(3, 1), {face(0.0)});
  EXPECT_EQ(found.nullity(), 3u);
  for (const UndeterminedDirection& direction : found.result.identifiability.unidentifiable) {
    if (direction.combination.size() < 2) continue;
    // Equal sizes, opposite signs, unit length.
    ASSERT_THAT(names(direction.combination),
                UnorderedElementsAre("squareness.dbeta_xz", "vertical_straightness.c1"));
    EXPECT_NEAR(direction.combination[0].second, -direction.combination[1].second, 1e-9);
    EXPECT_NEAR(std::abs(direction.combination[0].second), std::sqrt(0.5), 1e-9);
  }
  const auto& determined = found.result.identifiability.determined;
  ASSERT_EQ(determined.size(), 1u);
  EXPECT_THAT(names(determined[0].combination),
              UnorderedElementsAre("squareness.dbeta_xz", "vertical_straightness.c1"));
  // Four standard uncertainties of the sum 3e-5.
  EXPECT_NEAR(determined[0].value.value(), 3e-5, 4.0 * determined[0].standard_uncertainty.value());
  EXPECT_LT(found.largest_shift, kNothing);
}

TEST(Identifiability, AdviceIsTheSameInEveryOrderOfTheEffects) {
  std::vector<DeclaredEffect> effects = carriage(3, 1);
  for (int first = 0; first < 3;
       ++first, std::rotate(effects.begin(), effects.begin() + 1, effects.end())) {
    const Found found(effects, {face(0.0)});
    for (const UndeterminedDirection& direction : found.result.identifiability.unidentifiable)
      if (direction.combination.size() > 1) {
        EXPECT_THAT(direction.advice, HasSubstr("no face can tell c_1 from the squareness"));
      }
  }
}

TEST(Identifiability, OfARadiusLevelledHasNoSquareness) {
  std::vector<Profile> profiles{face(0.0)};
  profiles[0].free_tilt = true;
  const Found found(carriage(3, 0), profiles);
  EXPECT_THAT(found.undetermined,
              UnorderedElementsAre("straightness.b0", "straightness.b1", "squareness.dbeta_xz"));
  EXPECT_LT(found.largest_shift, kNothing);
}

TEST(Identifiability, OfALevelledDiameterHasTheSquarenessAsACone) {
  std::vector<Profile> profiles{face(0.0, -50.0)};
  profiles[0].free_tilt = true;
  const Found found(carriage(3, 0), profiles);
  EXPECT_THAT(found.undetermined, UnorderedElementsAre("straightness.b0", "straightness.b1"));
  const FittedParameter* squareness = found.result.find("squareness.dbeta_xz");
  // With c_1 = 1e-5 in the machine and not in the model: the sum, to four standard uncertainties.
  EXPECT_NEAR(*squareness->value, 3e-5, 4.0 * *squareness->standard_uncertainty);
}

TEST(Identifiability, OfThreeZLevelsLeavesOneCombinationOfC1AndSquareness) {
  const Found found(carriage(3, 3), {face(0.0), face(50.0), face(100.0)});
  EXPECT_THAT(found.undetermined,
              UnorderedElementsAre("straightness.b0", "straightness.b1", "squareness.dbeta_xz",
                                   "vertical_straightness.c1"));
  for (const auto& [name, truth] :
       {std::pair{"vertical_straightness.c2", 2e-7}, {"vertical_straightness.c3", -1e-9}}) {
    const FittedParameter* parameter = found.result.find(name);
    ASSERT_TRUE(parameter->value) << name;
    EXPECT_NEAR(*parameter->value, truth, 4.0 * *parameter->standard_uncertainty) << name;
  }
  const auto& determined = found.result.identifiability.determined;
  ASSERT_EQ(determined.size(), 1u);
  EXPECT_NEAR(determined[0].value.value(), 3e-5, 4.0 * determined[0].standard_uncertainty.value());
  EXPECT_LT(found.largest_shift, kNothing);
}

TEST(Identifiability, OfTwoZLevelsDoesNotReachC3) {
  const Found found(carriage(3, 3), {face(0.0), face(50.0)});
  EXPECT_EQ(found.nullity(), 4u);  // b_0, b_1, c_1 against the squareness, c_3 against the others
  EXPECT_FALSE(found.result.find("vertical_straightness.c3")->identifiable);
  EXPECT_LT(found.largest_shift, kNothing);
}

TEST(Identifiability, OfASlideReadingHasNoSquareness) {
  const std::vector<double> positions = cases::spaced(0.0, 50.0, 1600);
  RandomStream random(6, "slide");
  turning::Pass pass;
  pass.noise.white = 1e-5;
  const auto error = [](const turning::ToolPoint& tool) {
    return turning::polynomial(kLathe.b, tool.x);
  };
  Profile slide = cases::profile("slide", Kind::slide, positions,
                                 turning::slide_heights(error, positions, pass, random));
  const Found levelled(carriage(3, 0), {slide});
  EXPECT_THAT(levelled.undetermined,
              UnorderedElementsAre("straightness.b0", "straightness.b1", "squareness.dbeta_xz"));
  slide.free_offset = slide.free_tilt = false;
  const Found known(carriage(3, 0), {slide});
  EXPECT_THAT(known.undetermined, ElementsAre("squareness.dbeta_xz"));
  EXPECT_THAT(known.result.identifiability.determined, IsEmpty());
}

// Of p = j a the unit is 1 / j of a, whose column is as long as its scale; what moves nothing is 1.
TEST(ParameterScale, IsTheSizeOfOneUnitInTheData) {
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(3, 3);
  jacobian.diagonal() << 2.0, 1e-3, 0.0;
  EXPECT_LT((parameter_scale(jacobian, Eigen::Vector3d(3.0, 4.0, 5.0)) -
             Eigen::Vector3d(1.5, 4000.0, 1.0))
                .norm(),
            1e-9);
  EXPECT_EQ(parameter_scale(Eigen::MatrixXd(2, 0), Eigen::VectorXd(0)), Eigen::Vector2d::Ones());
}

// A height in µm and the distance that a slope of 1e-10 makes of it: neither is nothing beside the
// other.
TEST(ParameterScale, OfTwoParametersOfOneAmplitudeIsThatOfEachAlone) {
  const Eigen::Vector2d jacobian(1e3, 1e10);
  EXPECT_LT(
      (parameter_scale(jacobian, Eigen::VectorXd::Constant(1, 2.0)) - Eigen::Vector2d(2e-3, 2e-10))
          .cwiseQuotient(Eigen::Vector2d(2e-3, 2e-10))
          .norm(),
      1e-12);
}

TEST(Rank, OfNoColumnsIsNothing) {
  const Rank rank = analyse_rank(Eigen::MatrixXd(3, 0), Eigen::VectorXd(0), kTolerance);
  EXPECT_EQ(rank.basis.rows(), 0);
  EXPECT_EQ(rank.basis.cols(), 0);
  EXPECT_EQ(rank.null_space.cols(), 0);
  EXPECT_EQ(rank.condition, 1.0);
  const NullDirections null =
      null_directions(Model{{Machine::paper_lathe(), Lever::paper}, {}, {}, {}}, rank,
                      Eigen::MatrixXd(0, 0), Eigen::VectorXd(0));
  EXPECT_THAT(null.own, IsEmpty());
  EXPECT_EQ(determined_rows(null).rows(), 0);
}

// Unit columns at an angle of cosine c have the singular values √(1 ± c).
TEST(Rank, ConditionIsThatOfTheScaledColumnsWithinTheRank) {
  Eigen::MatrixXd columns(3, 4);
  columns << 3.0, 5.0 * 0.6, 0.0, 3.0,  //
      0.0, 5.0 * 0.8, 0.0, 0.0,         //
      0.0, 0.0, 0.0, 0.0;
  const auto condition = [&](Eigen::Index count) {
    const Eigen::Vector4d scale(3.0, 5.0, 7.0, 3.0);
    return analyse_rank(columns.leftCols(count), scale.head(count), kTolerance).condition;
  };
  EXPECT_NEAR(condition(1), 1.0, 1e-12);
  EXPECT_NEAR(condition(2), 2.0, 1e-12);  // √(1.6 / 0.4)
  EXPECT_NEAR(condition(3), 2.0, 1e-12);  // one of no size more
  // The first one twice: 2 a aᵀ + b bᵀ has the trace 3 and the determinant 2 (1 - c²).
  const double root = std::sqrt(9.0 - 8.0 * 0.64);
  EXPECT_NEAR(condition(4), std::sqrt((3.0 + root) / (3.0 - root)), 1e-12);
}

TEST(Rank, OfNoRowsDeterminesNothing) {
  const Rank rank = analyse_rank(Eigen::MatrixXd(0, 2), Eigen::Vector2d(2.0, 0.0), kTolerance);
  EXPECT_EQ(rank.basis.cols(), 0);
  EXPECT_EQ(rank.null_space.cols(), 2);
}

}  // namespace
}  // namespace slideway
