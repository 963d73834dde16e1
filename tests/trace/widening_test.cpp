// What a rival in the place of an accepted effect would make of the parameters, against least
// squares on columns written down here.

#include "widening.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>

#include "identify/cases.hpp"
#include "response.hpp"
#include "slideway/base/random.hpp"

namespace slideway::widening_test {
namespace {

constexpr double kNoise = 10e-6;  // mm, white
constexpr double kRadius = 40.0;
constexpr Eigen::Index kReadings = 200;

/// A face that is a cone, and bent with r^1.7: neither r^2, which is accepted, nor r^1.5, its
/// rival.
Profile bent_face() {
  RandomStream random(3, "rivals");
  std::vector<double> r = cases::spaced(0.5, kRadius, kReadings), z;
  for (const double at : r)
    z.push_back(-1e-5 * at + 2e-3 * std::pow(at / kRadius, 1.7) + kNoise * random.normal());
  Profile face = cases::face("face", 2.0, r, z);
  face.standard_uncertainty = kNoise;
  return face;
}

FittedModel fitted(const std::vector<Profile>& profiles, const std::vector<const char*>& effects) {
  std::vector<DeclaredEffect> declared;
  for (const char* name : effects) declared.push_back(cases::effect(name));
  const Problem problem = cases::problem(Lever::paper, 0, declared);
  Model model = build_model(problem, profiles);
  Solution solution = fit(model);
  return {std::move(model), std::move(solution)};
}

/// Slope of the face beside a column and the offset: but for its sign, Δβxz.
double slope_beside(const Eigen::VectorXd& column, const Observation& observation) {
  Eigen::MatrixXd design(kReadings, 3);
  for (Eigen::Index i = 0; i < kReadings; ++i)
    design.row(i) << 1.0, observation.profile->positions[static_cast<std::size_t>(i)], column[i];
  return design.colPivHouseholderQr().solve(observation.values)[1];
}

Eigen::VectorXd power(const Observation& observation, double exponent) {
  Eigen::VectorXd out(kReadings);
  for (Eigen::Index i = 0; i < kReadings; ++i)
    out[i] =
        std::pow(observation.profile->positions[static_cast<std::size_t>(i)] / kRadius, exponent);
  return out;
}

TEST(Widening, OfARivalIsTheChangeThatItsFitBrings) {
  const std::vector<Profile> profiles{bent_face()};
  const FittedModel with = fitted(profiles, {"squareness", "cup"});
  const FittedModel without = fitted(profiles, {"squareness"});
  const Observation& observation = with.model.observations[0];
  Candidate cup;
  cup.term = with.model.terms[1];
  TestedCandidate rival;
  rival.refined.candidate = &cup;
  rival.refined.columns = power(observation, 1.5);
  rival.refined.projection =
      project(Whitened(without.fit.linear, without.fit.noise), rival.refined.columns);

  Widening widening(with.fit.linear.prior_rows.cols());
  widening.add_rivals(with, without, {&rival});

  const double change = slope_beside(power(observation, 1.5), observation) -
                        slope_beside(power(observation, 2.0), observation);
  const ModelTerm& squareness = with.model.terms[0];
  const Eigen::RowVectorXd row = with.fit.parameters.jacobian.row(squareness.first_parameter);
  // 1e-6: normal equations of columns that are nearly one another.
  EXPECT_NEAR(widening.variance(row), change * change / 3.0, 1e-6 * change * change);
  EXPECT_GT(std::abs(change), 1e-6);
}

TEST(Widening, OfAnAbsenceIsTheChangeThatItBrings) {
  const std::vector<Profile> profiles{bent_face()};
  const FittedModel with = fitted(profiles, {"squareness", "cup"});
  const FittedModel without = fitted(profiles, {"squareness"});
  Widening widening(with.fit.linear.prior_rows.cols());
  widening.add_absence(with, without);
  const double change = with.fit.parameters.values[0] - without.fit.parameters.values[0];
  EXPECT_NEAR(widening.variance(with.fit.parameters.jacobian.row(0)), change * change / 3.0,
              1e-9 * change * change);
  EXPECT_GT(std::abs(change), 1e-6);
}

// Least squares is linear in the data: the slope of the signal beside the other columns.
TEST(RowResponse, OfASignalIsItsOwnFit) {
  const std::vector<Profile> profiles{bent_face()};
  const FittedModel fit = fitted(profiles, {"squareness", "cup"});
  const Observation& observation = fit.model.observations[0];
  const Eigen::VectorXd signal = 1e-3 * power(observation, 1.5);
  Eigen::MatrixXd design(kReadings, 3);
  for (Eigen::Index i = 0; i < kReadings; ++i) {
    const double r = observation.profile->positions[static_cast<std::size_t>(i)];
    design.row(i) << 1.0, r, r * r;
  }
  const double slope = design.colPivHouseholderQr().solve(signal)[1];
  EXPECT_NEAR(std::abs(RowResponse(fit.fit, fit.fit.parameters.jacobian.row(0)).to(signal)[0]),
              std::abs(slope), 1e-9 * std::abs(slope));
  EXPECT_NEAR(std::abs((fit.fit.parameters.jacobian * response(fit.fit, signal))(0, 0)),
              std::abs(slope), 1e-9 * std::abs(slope));
}

TEST(Widening, ByNothingIsNone) {
  const std::vector<Profile> profiles{bent_face()};
  const FittedModel with = fitted(profiles, {"squareness", "cup"});
  Widening widening(with.fit.linear.prior_rows.cols());
  widening.add_rivals(with, with, {});
  EXPECT_EQ(widening.variance(with.fit.parameters.jacobian.row(0)), 0.0);
}

}  // namespace
}  // namespace slideway::widening_test
