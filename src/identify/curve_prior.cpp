#include "slideway/identify/curve_prior.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "curve_likelihood.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/fit.hpp"

namespace slideway {

namespace {
constexpr Eigen::Index kValuesPerDirection = 3;  // of a curve: fewer leave too little for a noise
}  // namespace

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
  const double height = largest > 0.0 ? largest : kMicrometre;
  return {height, travel / 4.0, 1.5, height};
}

namespace {

/// Rows R with RᵀR the inverse of a covariance C become those of C + (a form of this height) ⊗
/// itself.
void add_form(double height, const Eigen::VectorXd& form, Eigen::MatrixXd& rows) {
  const Eigen::VectorXd white = height * (rows * form);
  const double size = white.squaredNorm();
  if (!(size > 0.0)) return;
  rows.noalias() -=
      (1.0 - 1.0 / std::sqrt(1.0 + size)) / size * white * (white.transpose() * rows).eval();
}

}  // namespace

Eigen::MatrixXd curve_prior_rows(const Knots& knots, const CurvePrior& prior) {
  const Eigen::MatrixXd root =
      prior.amplitude_mm * correlation_root(knots, prior.length_mm, prior.roughness);
  Eigen::MatrixXd rows = root.triangularView<Eigen::Lower>().solve(
      Eigen::MatrixXd::Identity(root.rows(), root.cols()));
  add_form(prior.bow_mm, bow_form(knots), rows);
  if (prior.kink)
    add_form(prior.kink->height_mm, kink_forms(knots).col(prior.kink->knot - 1), rows);
  return rows;
}

CurveEstimate estimate_curve(const Model& model, const Linearisation& linear,
                             const std::vector<Noise>& noise, const Estimate& estimate) {
  const CurveData data(*curve_term(model), linear, noise, estimate);
  const std::vector<Hypothesis> likely = likely_priors(data);
  const Hypothesis* const best = likeliest(likely);
  const CurvePrior prior = best ? best->prior : *estimate.curve;
  Eigen::Index values = 0;
  for (const Observation* observation : linear.observations)
    values += observation->values.size() - observation->nuisances.cols();
  return {prior, CurvePosterior(data, prior.length_mm, prior.roughness)
                     .determined(prior, values / kValuesPerDirection)};
}

Eigen::MatrixXd covariance_of_curve_prior(const Model& model, const Linearisation& linear,
                                          const std::vector<Noise>& noise,
                                          const Estimate& estimate) {
  const CurveData data(*curve_term(model), linear, noise, estimate);
  const CurvePrior& prior = *estimate.curve;
  const CurvePosterior own(data, prior.length_mm, prior.roughness);
  const std::vector<Hypothesis> likely = likely_priors(data);
  const Eigen::Index count = data.knots().positions_mm.size();
  Eigen::MatrixXd moments = Eigen::MatrixXd::Zero(count, count);
  if (!likely.empty())
    moments = second_moments(data, likely, own.mean(prior)) - own.covariance(prior);
  return data.carried() * moments * data.carried().transpose();
}

Linearisation beside_curve(const Model& model, const Linearisation& linear,
                           const CurveEstimate& curve, const Estimate& estimate) {
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
  for (std::size_t i = 0; i < out.columns.size(); ++i) {
    out.residuals[i] +=
        linear.columns[i].middleCols(first, own) * estimate.amplitudes.segment(first, own);
    out.columns[i] = replaced(linear.columns[i]);
  }
  const Eigen::Index declared = linear.prior_rows.rows() - linear.curve_rows;
  out.prior_rows = replaced(linear.prior_rows.topRows(declared));
  out.prior_residuals = linear.prior_residuals.head(declared);
  out.curve_rows = 0;
  return out;
}

}  // namespace slideway
