#include <Eigen/Dense>
#include <algorithm>

#include "residual.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kBlockRows = 512;

/// Upper triangle of a tall matrix fed in blocks of rows: each block is folded into the triangle of
/// those before it, so memory does not grow with the rows.
class TallQr {
 public:
  explicit TallQr(Eigen::Index columns) : triangle_(Eigen::MatrixXd::Zero(columns, columns)) {}

  void add(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    const Eigen::Index k = triangle_.cols();
    for (Eigen::Index first = 0; first < rows.rows(); first += kBlockRows) {
      const Eigen::Index count = std::min(kBlockRows, rows.rows() - first);
      work_.resize(k + count, k);
      work_ << triangle_, rows.middleRows(first, count);
      const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(work_);
      triangle_ = work_.topRows(k).triangularView<Eigen::Upper>();
    }
  }

  [[nodiscard]] const Eigen::MatrixXd& triangle() const { return triangle_; }

 private:
  Eigen::MatrixXd triangle_, work_;
};

/// The triangle of an observation's columns, nuisances projected out a block at a time.
Eigen::MatrixXd free_triangle(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& basis) {
  const Eigen::MatrixXd along = basis.transpose() * columns;
  TallQr qr(columns.cols());
  for (Eigen::Index first = 0; first < columns.rows(); first += kBlockRows) {
    const Eigen::Index count = std::min(kBlockRows, columns.rows() - first);
    qr.add(columns.middleRows(first, count) - basis.middleRows(first, count) * along);
  }
  return qr.triangle();
}

/// Rows (prior - parameter) / u of all priors, with their derivatives.
void set_priors(const Model& model, const Estimate& estimate, Linearisation& linear) {
  const Eigen::Index a = model.amplitudes(), s = model.shapes();
  const ParameterValues values = all_parameters(model, estimate);
  std::size_t count = 0;
  for (const ModelTerm& term : model.terms) count += term.priors.size();
  linear.prior_rows = Eigen::MatrixXd::Zero(count, a + s);
  linear.prior_residuals.resize(count);
  Eigen::Index row = 0;
  for (const ModelTerm& term : model.terms)
    for (const Prior& prior : term.priors) {
      const Eigen::Index p = term.first_parameter + parameter_index(term, prior.parameter);
      linear.prior_rows.row(row) = values.jacobian.row(p) / prior.standard_uncertainty;
      linear.prior_residuals[row] = (prior.value - values.values[p]) / prior.standard_uncertainty;
      ++row;
    }
}

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

}  // namespace

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

Linearisation linearise(const Model& model, const Estimate& estimate) {
  Linearisation linear;
  const Eigen::Index a = model.amplitudes(), s = model.shapes();
  linear.observations = fitted_observations(model);
  for (const Observation* observation : linear.observations) {
    Eigen::MatrixXd columns(observation->values.size(), a + s);
    for (const ModelTerm& term : model.terms) {
      const auto shape = shapes_of(term, estimate.shapes);
      const Eigen::Index count = term.effect->amplitudes();
      columns.middleCols(term.first_amplitude, count) =
          low_band_columns(model, term, *observation, shape);
      for (int j = 0; j < static_cast<int>(shape.size()); ++j)
        columns.col(a + term.first_shape + j) =
            low_band_derivatives(model, term, *observation, shape, j) *
            estimate.amplitudes.segment(term.first_amplitude, count);
    }
    linear.nuisance_bases.push_back(nuisance_basis(*observation));
    linear.triangles.push_back(free_triangle(columns, linear.nuisance_bases.back()));
    linear.squares.emplace_back(columns.colwise().squaredNorm().transpose());
    linear.columns.push_back(std::move(columns));
  }
  set_residuals(model, estimate, linear);
  return linear;
}

void relinearise(const Model& model, const Estimate& estimate, Linearisation& linear) {
  if (model.shapes() > 0)
    linear = linearise(model, estimate);
  else
    set_residuals(model, estimate, linear);
}

void refit_nuisances(const Model& model, Estimate& estimate, Linearisation& linear) {
  estimate.nuisances.clear();
  for (const Observation* observation : linear.observations)
    estimate.nuisances.emplace_back(Eigen::VectorXd::Zero(observation->nuisances.cols()));
  relinearise(model, estimate, linear);
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    if (observation.nuisances.cols() == 0) continue;
    estimate.nuisances[i] = fitted_nuisances(observation, linear.residuals[i]);
    linear.residuals[i].noalias() -= observation.nuisances * estimate.nuisances[i];
  }
}

ParameterValues all_parameters(const Model& model, const Estimate& estimate) {
  const Eigen::Index a = model.amplitudes(), s = model.shapes(), p = model.parameters();
  ParameterValues out{Eigen::VectorXd(p), Eigen::MatrixXd::Zero(p, a + s)};
  for (const ModelTerm& term : model.terms) {
    const Eigen::Index ta = term.effect->amplitudes();
    const auto shape = shapes_of(term, estimate.shapes);
    const ParameterValues values =
        term.effect->parameter_values(estimate.amplitudes.segment(term.first_amplitude, ta), shape);
    const Eigen::Index tp = values.values.size();
    out.values.segment(term.first_parameter, tp) = values.values;
    out.jacobian.block(term.first_parameter, term.first_amplitude, tp, ta) =
        values.jacobian.leftCols(ta);
    out.jacobian.block(term.first_parameter, a + term.first_shape, tp,
                       static_cast<Eigen::Index>(shape.size())) =
        values.jacobian.rightCols(static_cast<Eigen::Index>(shape.size()));
  }
  return out;
}

Triangle compress(const Linearisation& linear, const std::vector<double>& weights) {
  const Eigen::MatrixXd& priors = linear.prior_rows;
  Triangle out;
  TallQr qr(priors.cols());
  qr.add(priors);
  out.gradient = priors.transpose() * linear.prior_residuals;
  Eigen::VectorXd squares = priors.colwise().squaredNorm().transpose();
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const double weight = 1.0 / (weights[i] * weights[i]);
    qr.add(linear.triangles[i] / weights[i]);
    squares += weight * linear.squares[i];
    Eigen::MatrixXd residual = linear.residuals[i];
    project_out(linear.nuisance_bases[i], residual);
    out.gradient += weight * (linear.columns[i].transpose() * residual);
  }
  out.matrix = qr.triangle();
  out.scale = squares.cwiseSqrt();
  return out;
}

}  // namespace slideway
