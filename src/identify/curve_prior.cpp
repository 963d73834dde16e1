#include "slideway/identify/curve_prior.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "curve_likelihood.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/fit.hpp"

namespace slideway {

const ModelTerm* curve_term(const Model& model) {
  const auto found = std::ranges::find_if(
      model.terms, [](const ModelTerm& term) { return term.effect->knots().has_value(); });
  return found == model.terms.end() ? nullptr : &*found;
}

CurvePrior first_curve_prior(const Model& model, const Knots& knots) {
  const double travel = knots.positions_mm[knots.positions_mm.size() - 1] - knots.positions_mm[0];
  double largest = 0.0;
  for (const Observation* observation : fitted_observations(model)) {
    const double size = levelled(*observation, observation->values).norm() /
                        std::sqrt(static_cast<double>(observation->low_band.samples()));
    const bool slope = observation->profile->setup.quantity == Quantity::slope;
    largest = std::max(largest, slope ? size * travel : size);
  }
  return {largest > 0.0 ? largest : kMicrometre, travel / 4.0, 1.5};
}

Eigen::MatrixXd curve_prior_rows(const Knots& knots, const CurvePrior& prior) {
  Eigen::MatrixXd root =
      prior.amplitude_mm * correlation_root(knots, prior.length_mm, prior.roughness);
  if (prior.kink) {
    const Eigen::VectorXd kink =
        prior.kink->height_mm * kink_forms(knots).col(prior.kink->knot - 1);
    const Eigen::MatrixXd covariance = root * root.transpose() + kink * kink.transpose();
    root = covariance.llt().matrixL();
  }
  return root.triangularView<Eigen::Lower>().solve(
      Eigen::MatrixXd::Identity(root.rows(), root.cols()));
}

namespace {

double height_of_kink(const Model& model, const CurveData& data) {
  return first_curve_prior(model, data.knots()).amplitude_mm;
}

}  // namespace

CurveEstimate estimate_curve(const Model& model, const Linearisation& linear,
                             const std::vector<Noise>& noise, const Estimate& estimate) {
  const CurveData data(*curve_term(model), linear, noise, estimate);
  const std::vector<Hypothesis> likely = likely_priors(data, height_of_kink(model, data));
  const Hypothesis* const best = likeliest(likely);
  const CurvePrior prior = best ? best->prior : *estimate.curve;
  return {prior, CurvePosterior(data, prior.length_mm, prior.roughness).determined(prior)};
}

Eigen::MatrixXd covariance_of_curve_prior(const Model& model, const Linearisation& linear,
                                          const std::vector<Noise>& noise,
                                          const Estimate& estimate) {
  const CurveData data(*curve_term(model), linear, noise, estimate);
  const CurvePrior& prior = *estimate.curve;
  const CurvePosterior own(data, prior.length_mm, prior.roughness);
  const std::vector<Hypothesis> likely = likely_priors(data, height_of_kink(model, data));
  const Eigen::Index count = data.knots().positions_mm.size();
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(count, count);
  if (!likely.empty())
    moments = second_moments(data, likely, own.mean(prior)) - own.covariance(prior);
  return data.carried() * moments * data.carried().transpose();
}

Linearisation beside_curve(const Model& model, const Linearisation& linear,
                           const CurveEstimate& curve) {
  const ModelTerm& term = *curve_term(model);
  const Eigen::Index first = term.first_amplitude + term.effect->knots()->first;
  const Eigen::Index own = curve.determined.rows(), free = curve.determined.cols();
  Linearisation out = linear;
  const auto replaced = [&](const Eigen::MatrixXd& columns) {
    const Eigen::Index behind = columns.cols() - first - own;
    Eigen::MatrixXd all(columns.rows(), columns.cols() - own + free);
    all << columns.leftCols(first), columns.middleCols(first, own) * curve.determined,
        columns.rightCols(behind);
    return all;
  };
  for (Eigen::MatrixXd& columns : out.columns) columns = replaced(columns);
  const Eigen::Index declared = linear.prior_rows.rows() - linear.curve_rows;
  out.prior_rows = replaced(linear.prior_rows.topRows(declared));
  out.prior_residuals = linear.prior_residuals.head(declared);
  out.curve_rows = 0;
  return out;
}

namespace {

/// The declared polynomial form of a slide, or null where the model has none, or a curve.
const DeclaredEffect* declared_polynomial(const Problem& problem, const Model& model) {
  if (curve_term(model)) return nullptr;
  const auto found = std::ranges::find_if(problem.effects, [](const DeclaredEffect& each) {
    return motion_error_of(each.name) == MotionError::straightness;
  });
  return found == problem.effects.end() ? nullptr : &*found;
}

DeclaredEffect as_curve(const DeclaredEffect& polynomial, const TravelRange& range) {
  constexpr double kPieces = 24.0;  // of a curve that tells slow structure
  DeclaredEffect out{polynomial.name, polynomial.options, {}};
  out.options.degree.reset();
  out.options.form = Form::curve;
  out.options.resolution_mm = std::max(range.slide_max - range.slide_min, 1e-9) / kPieces;
  return out;
}

}  // namespace

void allow_for_other_form(const Problem& problem, FittedModel& fitted) {
  Solution& fit = fitted.fit;
  const Model& model = fitted.model;
  const DeclaredEffect* const polynomial = declared_polynomial(problem, model);
  if (!polynomial) return;
  Model with = model;
  append_term(with, as_curve(*polynomial, model.range), model.range);
  const ModelTerm& curve = with.terms.back();
  const Knots knots = *curve.effect->knots();
  Estimate estimate = fit.estimate;
  estimate.amplitudes.conservativeResizeLike(Eigen::VectorXd::Zero(with.amplitudes()));
  estimate.curve = first_curve_prior(with, knots);
  Linearisation linear = linearise(with, estimate);
  linear.residuals = fit.linear.residuals;
  for (Eigen::MatrixXd& columns : linear.columns)  // the polynomial has offset and slope
    columns.middleCols(curve.first_amplitude, knots.first).setZero();
  const CurveData data(curve, linear, fit.noise, estimate);
  const std::vector<Hypothesis> likely = likely_priors(data, 0.0);
  const Hypothesis* const best = likeliest(likely);
  if (!best || best->log_likelihood < -std::log(model.gates.lack_of_fit_p)) return;
  fit.other_form = best->log_likelihood;
  Eigen::MatrixXd moved(fit.uncertainty.basis.rows(), data.carried().cols());
  moved << data.carried().topRows(model.amplitudes()), data.carried().bottomRows(model.shapes());
  const Eigen::MatrixXd moments =
      second_moments(data, likely, Eigen::VectorXd::Zero(knots.positions_mm.size()));
  fit.uncertainty.add(moved * moments * moved.transpose(), compress(fit.linear, fit.noise));
}

}  // namespace slideway
