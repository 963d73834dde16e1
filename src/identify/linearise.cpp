#include <Eigen/Dense>
#include <algorithm>

#include "face_slope.hpp"
#include "slideway/base/error.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {
namespace {

/// Rows (prior - parameter) / u of all priors, with their derivatives; a curve's are the last.
void set_priors(const Model& model, const Estimate& estimate, Linearisation& linear) {
  const Eigen::Index a = model.amplitudes(), s = model.shapes();
  const ParameterValues values = all_parameters(model, estimate);
  std::size_t count = 0;
  for (const ModelTerm& term : model.terms) count += term.priors.size();
  const ModelTerm* const curve = curve_term(model);
  const std::optional<Knots> knots = curve ? curve->effect->knots() : std::nullopt;
  linear.curve_rows = knots ? knots->positions_mm.size() : 0;
  linear.prior_rows = Eigen::MatrixXd::Zero(count + linear.curve_rows, a + s);
  linear.prior_residuals.resize(count + linear.curve_rows);
  if (knots) {
    const Eigen::Index first = curve->first_amplitude + knots->first;
    auto rows = linear.prior_rows.block(count, first, linear.curve_rows, linear.curve_rows);
    rows = curve_prior_rows(*knots, *estimate.curve);
    linear.prior_residuals.tail(linear.curve_rows) =
        -rows * estimate.amplitudes.segment(first, linear.curve_rows);
  }
  Eigen::Index row = 0;
  for (const ModelTerm& term : model.terms)
    for (const Prior& prior : term.priors) {
      const Eigen::Index p = term.first_parameter + parameter_index(term, prior.parameter);
      linear.prior_rows.row(row) = values.jacobian.row(p) / prior.standard_uncertainty;
      linear.prior_residuals[row] = (prior.value - values.values[p]) / prior.standard_uncertainty;
      ++row;
    }
}

}  // namespace

void set_residuals(const Model& model, const Estimate& estimate, Linearisation& linear) {
  linear.residuals.clear();
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    Eigen::VectorXd residual = observation.values;
    residual.noalias() -= linear.columns[i].leftCols(model.amplitudes()) * estimate.amplitudes;
    if (estimate.nuisances[i].size() > 0)
      residual.noalias() -= observation.nuisances * estimate.nuisances[i];
    linear.residuals.push_back(std::move(residual));
  }
  set_priors(model, estimate, linear);
}

Eigen::Index parameter_index(const ModelTerm& term, const std::string& name) {
  const std::vector<Parameter>& parameters = term.effect->parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (parameters[p].name == name) return static_cast<Eigen::Index>(p);
  throw UsageError("effect '" + term.name + "' has no parameter '" + name + "'");
}

std::vector<const Observation*> fitted_observations(const Model& model) {
  std::vector<const Observation*> out;
  for (const Observation& observation : model.observations)
    if (observation.profile->role == Role::fit) out.push_back(&observation);
  return out;
}

Eigen::VectorXd model_values(const Model& model, const Observation& observation,
                             const Estimate& estimate) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(observation.values.size());
  for (const ModelTerm& term : model.terms)
    out += low_band_columns(model, term, observation, shapes_of(term, estimate.shapes)) *
           estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes());
  return out;
}

Eigen::VectorXd fitted_nuisances(const Observation& observation, const Eigen::VectorXd& rest) {
  if (observation.nuisances.cols() == 0) return Eigen::VectorXd(0);
  return observation.nuisances.householderQr().solve(rest);
}

Eigen::MatrixXd linear_columns(const Model& model, const Estimate& estimate,
                               const Observation& observation) {
  constexpr double kLeastColumn = 1e-100;  // a smaller one has no square: nothing shows the effect
  const Eigen::Index a = model.amplitudes();
  Eigen::MatrixXd columns(observation.values.size(), a + model.shapes());
  for (const ModelTerm& term : model.terms) {
    const auto shape = shapes_of(term, estimate.shapes);
    const Eigen::Index count = term.effect->amplitudes();
    auto own = columns.middleCols(term.first_amplitude, count);
    own = low_band_columns(model, term, observation, shape);
    for (auto column : own.colwise())
      if (column.lpNorm<Eigen::Infinity>() < kLeastColumn) column.setZero();
    if (shape.empty()) continue;
    columns.middleCols(a + term.first_shape, std::ssize(shape)) = low_band_slopes(
        model, term, observation, shape, estimate.amplitudes.segment(term.first_amplitude, count));
  }
  return columns;
}

Linearisation linearise(const Model& model, const Estimate& estimate) {
  Linearisation linear;
  linear.observations = fitted_observations(model);
  for (const Observation* observation : linear.observations)
    linear.columns.push_back(linear_columns(model, estimate, *observation));
  set_residuals(model, estimate, linear);
  return linear;
}

void relinearise(const Model& model, const Estimate& estimate, Linearisation& linear) {
  if (model.shapes() > 0)
    linear = linearise(model, estimate);
  else
    set_residuals(model, estimate, linear);
}

ParameterValues all_parameters(const Model& model, const Estimate& estimate) {
  const Eigen::Index a = model.amplitudes(), s = model.shapes(), p = model.parameters();
  ParameterValues out{Eigen::VectorXd(p), Eigen::MatrixXd::Zero(p, a + s)};
  for (const ModelTerm& term : model.terms) {
    const Eigen::Index ta = term.effect->amplitudes();
    const auto shape = shapes_of(term, estimate.shapes);
    const auto ts = static_cast<Eigen::Index>(shape.size());
    const ParameterValues values =
        term.effect->parameter_values(estimate.amplitudes.segment(term.first_amplitude, ta), shape);
    const Eigen::Index tp = values.values.size();
    out.values.segment(term.first_parameter, tp) = values.values;
    out.jacobian.block(term.first_parameter, term.first_amplitude, tp, ta) =
        values.jacobian.leftCols(ta);
    out.jacobian.block(term.first_parameter, a + term.first_shape, tp, ts) =
        values.jacobian.rightCols(ts);
    if (values.by_slope.size() > 0)
      out.jacobian.block(term.first_parameter, 0, tp, a) +=
          values.by_slope * rms_slope_by_amplitude(model, estimate);
  }
  return out;
}

}  // namespace slideway
