// The two traps of correlated residuals: noise taken for an effect, and an effect taken for noise.

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/shape_grid.hpp"
#include "trace/faces.hpp"

namespace slideway {
namespace {

using namespace faces;  // NOLINT(google-build-using-namespace)
using turning::Hidden;
using turning::ToolPoint;

/// What a test that takes the residual for white noise says: the largest ΔBIC any period of the
/// slide brings to the residual of the fit, n ln(RSS0 / RSS1) - 3 ln n.
double naive_gain(const Problem& problem, const std::vector<Profile>& profiles) {
  const Model model = build_model(problem, profiles);
  const Solution fitted = fit(model);
  Model with = build_model(problem, profiles);
  append_term(with, {"slide_periodic", {}, {}}, with.range);
  const ModelTerm& term = with.terms.back();
  const Observation& observation = *fitted.linear.observations[0];
  const Eigen::Index n = observation.values.size();
  const Eigen::VectorXd& residual = fitted.linear.residuals[0];
  Eigen::MatrixXd span(n, observation.nuisances.cols() + fitted.linear.columns[0].cols() + 2);
  span << observation.nuisances, fitted.linear.columns[0], Eigen::MatrixXd::Zero(n, 2);
  double best = -INFINITY;
  for (const double period : shape_grid(with, term, 0)) {
    span.rightCols(2) = low_band_columns(with, term, observation, {&period, 1});
    const Eigen::VectorXd unit =
        span.colwise().norm().transpose().unaryExpr([](double s) { return s > 0 ? 1 / s : 0.0; });
    const Eigen::MatrixXd scaled = span * unit.asDiagonal();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(scaled);
    const Eigen::VectorXd rest = residual - scaled * qr.solve(residual);
    const auto count = static_cast<double>(n);
    best = std::max(best, count * std::log(residual.squaredNorm() / rest.squaredNorm()) -
                              3.0 * std::log(count));
  }
  return best;
}

// Each loop claims a false-alarm rate of `significance` = 1 %: at least one in 12 would come up
// with a probability of 11 %, at least two with 0.6 %. The seeds are fixed.
TEST(Trap, CleanFacesWithCorrelatedNoiseHaveNoEffectWhereANaiveTestSeesOne) {
  const Problem problem = problem_of();
  int naive = 0, false_alarms = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const std::vector<Profile> cut = quarter_faces({"clean"}, 1, kBlunt, seed);
    const Closed result = closed(problem, cut);
    if (!named(result).empty()) {
      ++false_alarms;
      ADD_FAILURE() << "seed " << seed << ": " << story(result);
    }
    EXPECT_NE(result.verdict, TraceVerdict::unnamed) << "seed " << seed << ": " << story(result);
    if (naive_gain(problem, cut) > 10.0) ++naive;
  }
  EXPECT_EQ(false_alarms, 0);
  EXPECT_GE(naive, 11);
  std::cout << "named in " << false_alarms << " of 12 clean faces; by the naive test in " << naive
            << '\n';
}

void expect_found(const Hidden& hidden, const std::string& parameter, double truth) {
  const Closed result = closed(problem_of(), quarter_faces(hidden, 3, kBlunt, 7));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ::testing::ElementsAre(hidden.name));
  const TraceRound* round = round_of(result, hidden.name);
  ASSERT_NE(round, nullptr);
  expect_within_4u(round->parameters, parameter, truth);
  expect_within_4u(result.final.parameters, "squareness.dbeta_xz", turning::kFaceSquareness);
}

/// The bias of a parameter by the missing effect falls by nine tenths. The effect is ten times as
/// large as in the traps, so that a tenth of its bias still stands out of the noise, and the nose
/// sharp enough to follow its slope (a groove is lowered by slope² times half the nose radius).
void expect_bias_removed(const Hidden& hidden, const std::string& parameter, double truth) {
  const Closed result = closed(
      problem_of({"linear_drift", "thermal_drift", "tool_wear", "tool_running_in", "feed_marks"}),
      quarter_faces(hidden, 3, kSharp, 7));
  SCOPED_TRACE(story(result));
  const FittedParameter* before = find(result.declared.parameters, parameter);
  const FittedParameter* after = find(result.final.parameters, parameter);
  ASSERT_TRUE(before && after);
  const double bias = std::abs(*before->value - truth);
  // U allows for every memory of the noise that the cuts do not exclude.
  EXPECT_LT(2.0 * *after->standard_uncertainty, 0.25 * bias);
  EXPECT_LT(std::abs(*after->value - truth), 0.1 * bias);
}

TEST(Trap, ThermalDriftOfFortyTimesTheNoiseIsNotTakenForNoise) {
  expect_found(
      {"thermal_drift", [](const ToolPoint& p) { return 0.6e-3 * (1.0 - std::exp(-p.t / 73.0)); }},
      "thermal_drift.amplitude_um", 0.6);
}

TEST(Trap, ToolWearIsNotTakenForNoise) {
  // 0.6 µm over the 17.3 m a cut of 2 mm/min is long
  expect_found({"tool_wear", [](const ToolPoint& p) { return 0.6e-3 * p.s / 17.3e3; }},
               "tool_wear.rate_um_per_m", 0.6 / 17.3);
}

// On a diameter the cut runs there and back: a line in time is two, with a kink at the axis. One
// cut's was taken for noise, and the other's could then be the slide's.
TEST(Trap, ALineThatRunsThereAndBackIsNotTakenForNoise) {
  RandomStream random(102, "time_periodic");
  const Closed result =
      closed(turning::face_problem(),
             turning::make_faces(turning::make_hidden("time_periodic", 0.23648e-3, random), 2,
                                 kSharp, 102));
  SCOPED_TRACE(story(result));
  EXPECT_THAT(named(result), ::testing::AnyOf(::testing::Contains("time_periodic"),
                                              ::testing::Contains("revolution_periodic")));
  // What is left is the stylus' noise, 11 nm, and what the nose makes of the line.
  EXPECT_LT(result.final.rms_um, 0.03);
}

TEST(Trap, BiasOfTheSquarenessByADriftFallsByNineTenths) {
  expect_bias_removed(
      {"thermal_drift", [](const ToolPoint& p) { return 6e-3 * (1.0 - std::exp(-p.t / 73.0)); }},
      "squareness.dbeta_xz", turning::kFaceSquareness);
}

// Wear goes with r² at every feed, so what it bends is b_2; on like positions the squareness stays.
TEST(Trap, BiasOfTheCurvatureByWearFallsByNineTenths) {
  expect_bias_removed({"tool_wear", [](const ToolPoint& p) { return 6e-3 * p.s / 17.3e3; }},
                      "straightness.b2", 2e-7);
}

}  // namespace
}  // namespace slideway
