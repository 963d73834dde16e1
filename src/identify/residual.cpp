#include "residual.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

double slope_of_outer(double outer, const Shape& kind) { return kind.logarithmic ? outer : 1.0; }

}  // namespace

Eigen::MatrixXd nuisance_basis(const Observation& observation) {
  const Eigen::MatrixXd& nuisances = observation.nuisances;
  if (nuisances.cols() == 0) return nuisances;
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(nuisances);
  return qr.householderQ() * Eigen::MatrixXd::Identity(nuisances.rows(), nuisances.cols());
}

void project_out(const Eigen::MatrixXd& basis, Eigen::Ref<Eigen::MatrixXd> columns) {
  if (basis.cols() == 0) return;
  const Eigen::MatrixXd along = basis.transpose() * columns;
  columns.noalias() -= basis * along;
}

Eigen::Index parameter_index(const ModelTerm& term, const std::string& name) {
  const std::vector<Parameter>& parameters = term.effect->parameters();
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (parameters[p].name == name) return static_cast<Eigen::Index>(p);
  throw UsageError("effect '" + term.name + "' has no parameter '" + name + "'");
}

/// Rows of all observations, weighted and free of nuisances; the priors' rows are left zero.
template <typename ColumnsOf>
Eigen::MatrixXd Residual::stacked(Eigen::Index cols, ColumnsOf&& columns_of) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows_, cols);
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    auto block = out.middleRows(first_row_[i], observations_[i]->values.size());
    block = columns_of(i) / weights_[i];
    project_out(bases_[i], block);
  }
  return out;
}

Residual::Residual(const Model& model, const Linearisation& linear,
                   const std::vector<double>& weights, const Estimate& start)
    : model_(model), weights_(weights) {
  for (const ModelTerm& term : model.terms) {
    if (term.effect->shapes().empty()) continue;
    moving_.push_back(&term);
    for (int s = 0; s < static_cast<int>(term.effect->shapes().size()); ++s)
      shapes_.emplace_back(&term, s);
    for (Eigen::Index a = 0; a < term.effect->amplitudes(); ++a)
      amplitudes_.push_back(term.first_amplitude + a);
  }
  set_up_rows(linear);
  set_up_fixed(linear);
  shape_values_ = start.shapes;
  set_num_residuals(static_cast<int>(rank() + (moving_.empty() ? 0 : rows_) + prior_count()));
  if (size() > 0) mutable_parameter_block_sizes()->push_back(static_cast<int32_t>(size()));
}

void Residual::set_up_rows(const Linearisation& linear) {
  observations_ = linear.observations;
  bases_ = linear.nuisance_bases;
  for (const Observation* observation : observations_) {
    first_row_.push_back(rows_);
    rows_ += observation->values.size();
  }
  rows_ += linear.prior_rows.rows();
}

/// Orthogonal factorisation of the columns that never move, once.
void Residual::set_up_fixed(const Linearisation& linear) {
  for (const ModelTerm& term : model_.terms)
    if (term.effect->shapes().empty())
      for (Eigen::Index a = 0; a < term.effect->amplitudes(); ++a)
        fixed_.push_back(term.first_amplitude + a);
  const auto pick = [&](const Eigen::MatrixXd& columns) {
    Eigen::MatrixXd out(columns.rows(), fixed_.size());
    for (std::size_t f = 0; f < fixed_.size(); ++f) out.col(f) = columns.col(fixed_[f]);
    return out;
  };
  const auto k = static_cast<Eigen::Index>(fixed_.size());
  const Triangle triangle = compress(linear, weights_);
  const Eigen::VectorXd scale = pick(triangle.scale.transpose()).transpose();
  if (moving_.empty()) {
    const Rank rank = analyse_rank(triangle.matrix, scale);
    fixed_basis_ = rank.basis;
    target_ = rank.basis.transpose() * triangle.gradient;
    return;
  }
  Eigen::MatrixXd columns = stacked(k, [&](std::size_t i) { return pick(linear.columns[i]); });
  Eigen::VectorXd values =
      stacked(1, [&](std::size_t i) { return Eigen::MatrixXd(observations_[i]->values); });
  const Eigen::Index priors = linear.prior_rows.rows();
  columns.bottomRows(priors) = pick(linear.prior_rows);
  for (Eigen::Index p = 0; p < priors; ++p)  // priors of moving terms have rows of their own
    if (columns.row(rows_ - priors + p).squaredNorm() > 0.0)
      values[rows_ - priors + p] = linear.prior_residuals[p];
  if (k == 0) {
    rest_ = values;
    span_.resize(values.size(), 0);
    target_.resize(0);
    fixed_basis_.resize(0, 0);
    return;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd upper =
      qr.matrixQR().topRows(std::min(k, columns.rows())).triangularView<Eigen::Upper>();
  fixed_basis_ = analyse_rank(upper, scale).basis;
  span_ = columns * fixed_basis_;
  target_ = span_.transpose() * values;
  rest_ = values - span_ * target_;
}

Eigen::Index Residual::prior_count() const {
  Eigen::Index count = 0;
  for (const ModelTerm* term : moving_) count += static_cast<Eigen::Index>(term->priors.size());
  return count;
}

bool Residual::Evaluate(const double* const* parameters, double* residuals,
                        double** jacobians) const {
  const Eigen::Map<const Eigen::VectorXd> x(parameters[0], size());
  Eigen::Map<Eigen::VectorXd> out(residuals, num_residuals());
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Eigen::MatrixXd jacobian;
  if (jacobians && jacobians[0]) jacobian = Eigen::MatrixXd::Zero(num_residuals(), size());
  evaluate(x, out, jacobian);
  if (jacobians && jacobians[0])
    Eigen::Map<RowMajor>(jacobians[0], num_residuals(), size()) = jacobian;
  return out.allFinite();
}

Estimate Residual::estimate(const Eigen::VectorXd& x) const {
  Estimate out;
  out.amplitudes = Eigen::VectorXd::Zero(model_.amplitudes());
  out.shapes = shape_values_;
  const Eigen::VectorXd fixed = fixed_basis_ * x.head(rank());
  for (std::size_t f = 0; f < fixed_.size(); ++f) out.amplitudes[fixed_[f]] = fixed[f];
  for (std::size_t a = 0; a < amplitudes_.size(); ++a)
    out.amplitudes[amplitudes_[a]] = x[rank() + a];
  for (std::size_t s = 0; s < shapes_.size(); ++s) {
    const auto& [term, which] = shapes_[s];
    out.shapes[term->first_shape + which] =
        term->effect->shapes()[which].outer(x[rank() + amplitudes_.size() + s]);
  }
  return out;
}

Eigen::VectorXd Residual::linear_optimum(const Eigen::VectorXd& shapes, double* cost) const {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(size());
  for (std::size_t s = 0; s < shapes_.size(); ++s) {
    const auto& [term, which] = shapes_[s];
    x[rank() + amplitudes_.size() + s] =
        term->effect->shapes()[which].inner(shapes[term->first_shape + which]);
  }
  Eigen::VectorXd residual(num_residuals());
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(num_residuals(), size());
  evaluate(x, residual, jacobian);
  const Eigen::Index linear = rank() + static_cast<Eigen::Index>(amplitudes_.size());
  const Eigen::VectorXd step =
      -jacobian.leftCols(linear).completeOrthogonalDecomposition().solve(residual);
  x.head(linear) += step;
  if (cost) *cost = 0.5 * (residual + jacobian.leftCols(linear) * step).squaredNorm();
  return x;
}

void Residual::evaluate(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out,
                        Eigen::MatrixXd& jacobian) const {
  const Eigen::Index r = rank();
  const bool wanted = jacobian.size() > 0;
  out.head(r) = x.head(r) - target_;
  if (wanted) jacobian.topLeftCorner(r, r).setIdentity();
  if (moving_.empty()) return;
  const Estimate now = estimate(x);
  const auto a = static_cast<Eigen::Index>(amplitudes_.size());
  const auto s = static_cast<Eigen::Index>(shapes_.size());
  const Eigen::MatrixXd moved = stacked(a + (wanted ? s : 0), [&](std::size_t i) {
    return moving_columns(*observations_[i], now, wanted);
  });
  const Eigen::MatrixXd inside = span_.transpose() * moved;
  const Eigen::MatrixXd outside = moved - span_ * inside;
  out.head(r) += inside.leftCols(a) * x.segment(r, a);
  out.segment(r, rows_) = outside.leftCols(a) * x.segment(r, a) - rest_;
  if (wanted) {
    jacobian.block(0, r, r, a + s) = inside;
    jacobian.block(r, r, rows_, a + s) = outside;
    for (Eigen::Index j = 0; j < s; ++j) {
      const auto& [term, which] = shapes_[j];
      jacobian.col(r + a + j) *=
          slope_of_outer(now.shapes[term->first_shape + which], term->effect->shapes()[which]);
    }
  }
  evaluate_priors(now, out, jacobian);
}

/// [columns of the moving terms, d(columns * amplitudes)/d(shapes)]
Eigen::MatrixXd Residual::moving_columns(const Observation& observation, const Estimate& now,
                                         bool derivatives) const {
  Eigen::MatrixXd out(observation.values.size(),
                      amplitudes_.size() + (derivatives ? shapes_.size() : 0));
  Eigen::Index next = 0;
  for (const ModelTerm* term : moving_) {
    const Eigen::Index count = term->effect->amplitudes();
    out.middleCols(next, count) =
        low_band_columns(model_, *term, observation, shapes_of(*term, now.shapes));
    next += count;
  }
  if (!derivatives) return out;
  for (const auto& [term, which] : shapes_)
    out.col(next++) =
        low_band_derivatives(model_, *term, observation, shapes_of(*term, now.shapes), which) *
        now.amplitudes.segment(term->first_amplitude, term->effect->amplitudes());
  return out;
}

void Residual::evaluate_priors(const Estimate& now, Eigen::Ref<Eigen::VectorXd> out,
                               Eigen::MatrixXd& jacobian) const {
  Eigen::Index row = rank() + rows_, amplitude = rank(),
               shape = rank() + static_cast<Eigen::Index>(amplitudes_.size());
  for (const ModelTerm* term : moving_) {
    const Eigen::Index a = term->effect->amplitudes();
    const auto s = static_cast<Eigen::Index>(term->effect->shapes().size());
    const ParameterValues values = term->effect->parameter_values(
        now.amplitudes.segment(term->first_amplitude, a), shapes_of(*term, now.shapes));
    for (const Prior& prior : term->priors) {
      const Eigen::Index p = parameter_index(*term, prior.parameter);
      out[row] = (values.values[p] - prior.value) / prior.standard_uncertainty;
      if (jacobian.size() > 0) {
        jacobian.block(row, amplitude, 1, a) =
            values.jacobian.row(p).head(a) / prior.standard_uncertainty;
        for (Eigen::Index j = 0; j < s; ++j)
          jacobian(row, shape + j) =
              values.jacobian(p, a + j) / prior.standard_uncertainty *
              slope_of_outer(now.shapes[term->first_shape + j], term->effect->shapes()[j]);
      }
      ++row;
    }
    amplitude += a;
    shape += s;
  }
}

}  // namespace slideway
