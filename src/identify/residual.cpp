#include "residual.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Writes a Jacobian block, if Ceres wants it.
void give(double** jacobians, std::size_t block, const Eigen::MatrixXd& columns) {
  if (jacobians && jacobians[block])
    Eigen::Map<RowMajor>(jacobians[block], columns.rows(), columns.cols()) = columns;
}

Eigen::Map<const Eigen::VectorXd> vector_of(const double* block, Eigen::Index size) {
  return {block, size};
}

/// Replaces each residual f by sign(f) sqrt(ρ(f²)) and scales its row of the Jacobian by the
/// derivative, f ρ'(f²) / sqrt(ρ(f²)), 1 at 0.
void robustify(const ceres::LossFunction& loss, Eigen::Ref<Eigen::VectorXd> residuals,
               Eigen::Ref<Eigen::MatrixXd> jacobian) {
  for (Eigen::Index t = 0; t < residuals.size(); ++t) {
    const double f = residuals[t];
    double rho[3];
    loss.Evaluate(f * f, rho);
    const double root = std::sqrt(rho[0]);
    if (root > 0.0) jacobian.row(t) *= std::abs(f) * rho[1] / root;
    residuals[t] = std::copysign(root, f);
  }
}

}  // namespace

std::unique_ptr<ceres::LossFunction> make_loss(Loss loss) {
  constexpr double kHuber = 1.345, kCauchy = 2.385;
  switch (loss) {
    case Loss::huber:
      return std::make_unique<ceres::HuberLoss>(kHuber);
    case Loss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(kCauchy);
    case Loss::none:
      break;
  }
  return nullptr;
}

double slope_of_outer(const Shape& kind, double outer) { return kind.logarithmic ? outer : 1.0; }

std::vector<double> outer_shapes(const ModelTerm& term, const double* inner) {
  std::vector<double> out;
  for (const Shape& kind : term.effect->shapes()) out.push_back(kind.outer(inner[out.size()]));
  return out;
}

Unknowns::Unknowns(const Model& model, const Estimate& start) {
  const std::vector<const Observation*> observations = fitted_observations(model);
  for (std::size_t i = 0; i < observations.size(); ++i)
    levelling.emplace_back(start.nuisances[i].head(std::ssize(observations[i]->nuisance_names)));
  for (const ModelTerm& each : model.terms) {
    Term& term = terms.emplace_back();
    term.term = &each;
    term.amplitudes = start.amplitudes.segment(each.first_amplitude, each.effect->amplitudes());
    const std::vector<Shape>& kinds = each.effect->shapes();
    term.shapes.resize(std::ssize(kinds));
    for (std::size_t s = 0; s < kinds.size(); ++s)
      term.shapes[s] =
          kinds[s].inner(start.shapes[each.first_shape + static_cast<Eigen::Index>(s)]);
  }
}

Estimate Unknowns::estimate(const Model& model) const {
  Estimate out;
  out.amplitudes.resize(model.amplitudes());
  out.shapes.resize(model.shapes());
  for (const Term& each : terms) {
    out.amplitudes.segment(each.term->first_amplitude, each.amplitudes.size()) = each.amplitudes;
    const std::vector<double> shapes = outer_shapes(*each.term, each.shapes.data());
    std::copy(shapes.begin(), shapes.end(), out.shapes.data() + each.term->first_shape);
  }
  const std::vector<const Observation*> observations = fitted_observations(model);
  for (std::size_t i = 0; i < levelling.size(); ++i) {
    out.nuisances.emplace_back(Eigen::VectorXd::Zero(observations[i]->nuisances.cols()));
    out.nuisances[i].head(levelling[i].size()) = levelling[i];
  }
  return out;
}

ProfileResidual::ProfileResidual(const Model& model, const Observation& observation,
                                 const Noise& noise, const Eigen::MatrixXd& columns)
    : model_(model),
      observation_(observation),
      noise_(noise),
      loss_(make_loss(observation.profile->loss)) {
  const Eigen::Index levelling = std::ssize(observation.nuisance_names);
  Eigen::MatrixXd left_out = observation.nuisances.rightCols(observation.left_out());
  noise.whiten(left_out);
  left_out_ = orthonormal(std::move(left_out));
  levelling_ = white(observation.nuisances.leftCols(levelling));
  columns_ = white(columns.leftCols(model.amplitudes()));
  values_ = white(observation.values);
  set_num_residuals(static_cast<int>(values_.size()));
  std::vector<int32_t>& sizes = *mutable_parameter_block_sizes();
  if (levelling > 0) sizes.push_back(static_cast<int32_t>(levelling));
  for (const ModelTerm& term : model.terms) {
    sizes.push_back(term.effect->amplitudes());
    if (!term.effect->shapes().empty())
      sizes.push_back(static_cast<int32_t>(term.effect->shapes().size()));
  }
}

Eigen::MatrixXd ProfileResidual::white(Eigen::MatrixXd columns) const {
  noise_.whiten(columns);
  if (left_out_.cols() > 0) columns -= left_out_ * (left_out_.transpose() * columns).eval();
  return columns;
}

bool ProfileResidual::Evaluate(const double* const* parameters, double* residuals,
                               double** jacobians) const {
  Eigen::Map<Eigen::VectorXd> out(residuals, num_residuals());
  out = -values_;
  std::vector<Eigen::MatrixXd> blocks;  // of the Jacobian
  const auto add = [&](Eigen::MatrixXd columns) {
    out += columns * vector_of(parameters[blocks.size()], columns.cols());
    blocks.push_back(std::move(columns));
  };
  if (levelling_.cols() > 0) add(levelling_);
  for (const ModelTerm& term : model_.terms) {
    const Eigen::Index a = term.effect->amplitudes();
    const auto s = static_cast<Eigen::Index>(term.effect->shapes().size());
    if (s == 0) {
      add(columns_.middleCols(term.first_amplitude, a));
      continue;
    }
    const std::vector<double> shapes = outer_shapes(term, parameters[blocks.size() + 1]);
    const auto amplitudes = vector_of(parameters[blocks.size()], a);
    add(white(low_band_columns(model_, term, observation_, shapes)));
    blocks.emplace_back(out.size(), s);
    if (!jacobians) continue;
    Eigen::MatrixXd slopes = low_band_slopes(model_, term, observation_, shapes, amplitudes);
    for (Eigen::Index j = 0; j < s; ++j)
      slopes.col(j) *= slope_of_outer(term.effect->shapes()[j], shapes[j]);
    blocks.back() = white(std::move(slopes));
  }
  if (loss_) {
    Eigen::VectorXd robust = out;
    for (Eigen::MatrixXd& block : blocks) {
      robust = out;
      robustify(*loss_, robust, block);
    }
    out = robust;
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) give(jacobians, b, blocks[b]);
  return out.allFinite();
}

CompressedResidual::CompressedResidual(const Model& model, const ProfileTriangle& of_values)
    : upper_(of_values.free().topRows(of_values.columns())) {
  constexpr double kTakenByLevelling = 1e-9;  // of a column, what is left of it: rounding
  for (Eigen::Index j = 0; j < of_values.columns(); ++j)
    if (upper_.col(j).norm() <= kTakenByLevelling * std::sqrt(of_values.squares()[j]))
      upper_.col(j).setZero();
  set_num_residuals(static_cast<int>(upper_.rows()));
  for (const ModelTerm& term : model.terms)
    mutable_parameter_block_sizes()->push_back(term.effect->amplitudes());
}

bool CompressedResidual::Evaluate(const double* const* parameters, double* residuals,
                                  double** jacobians) const {
  Eigen::Map<Eigen::VectorXd> out(residuals, num_residuals());
  out = -upper_.rightCols(1);
  Eigen::Index first = 0;
  for (std::size_t b = 0; b < parameter_block_sizes().size(); ++b) {
    const Eigen::Index size = parameter_block_sizes()[b];
    const auto columns = upper_.middleCols(first, size);
    out += columns * vector_of(parameters[b], size);
    give(jacobians, b, columns);
    first += size;
  }
  return out.allFinite();
}

PriorResidual::PriorResidual(const ModelTerm& term, const Prior& prior)
    : term_(term), prior_(prior), parameter_(parameter_index(term, prior.parameter)) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->push_back(term.effect->amplitudes());
  if (!term.effect->shapes().empty())
    mutable_parameter_block_sizes()->push_back(static_cast<int32_t>(term.effect->shapes().size()));
}

bool PriorResidual::Evaluate(const double* const* parameters, double* residuals,
                             double** jacobians) const {
  const Eigen::Index a = term_.effect->amplitudes();
  const bool moves = !term_.effect->shapes().empty();
  const std::vector<double> shapes =
      moves ? outer_shapes(term_, parameters[1]) : std::vector<double>{};
  const ParameterValues values =
      term_.effect->parameter_values(vector_of(parameters[0], a), shapes);
  residuals[0] = (values.values[parameter_] - prior_.value) / prior_.standard_uncertainty;
  Eigen::MatrixXd row = values.jacobian.row(parameter_) / prior_.standard_uncertainty;
  for (std::size_t j = 0; j < shapes.size(); ++j)
    row(0, a + static_cast<Eigen::Index>(j)) *=
        slope_of_outer(term_.effect->shapes()[j], shapes[j]);
  give(jacobians, 0, row.leftCols(a));
  if (moves) give(jacobians, 1, row.rightCols(std::ssize(shapes)));
  return std::isfinite(residuals[0]);
}

CurveResidual::CurveResidual(const Effect& effect, const Eigen::MatrixXd& rows)
    : rows_(Eigen::MatrixXd::Zero(rows.rows(), effect.amplitudes())) {
  rows_.middleCols(effect.knots()->first, rows.cols()) = rows;
  set_num_residuals(static_cast<int>(rows_.rows()));
  mutable_parameter_block_sizes()->push_back(effect.amplitudes());
}

bool CurveResidual::Evaluate(const double* const* parameters, double* residuals,
                             double** jacobians) const {
  Eigen::Map<Eigen::VectorXd> out(residuals, num_residuals());
  out = rows_ * vector_of(parameters[0], rows_.cols());
  give(jacobians, 0, rows_);
  return out.allFinite();
}

EliminatedResidual::EliminatedResidual(const Model& model, const Linearisation& linear,
                                       const std::vector<Noise>& noise)
    : model_(model), observations_(linear.observations), noise_(noise) {
  for (const ModelTerm& term : model.terms)
    if (!term.effect->shapes().empty()) moving_.push_back(&term);
  for (const Observation* observation : observations_) rows_ += observation->values.size();
  nuisances_ = own_bases(observations_, noise_);
  fixed_.resize(rows_, 0);
  fixed_ = orthonormal(outside(model.amplitudes(), [&](std::size_t i) {
    Eigen::MatrixXd rows =
        Eigen::MatrixXd::Zero(observations_[i]->values.size(), model.amplitudes());
    for (const ModelTerm& term : model.terms)
      if (term.effect->shapes().empty())
        rows.middleCols(term.first_amplitude, term.effect->amplitudes()) =
            linear.columns[i].middleCols(term.first_amplitude, term.effect->amplitudes());
    return rows;
  }));
  residual_ = outside(1, [&](std::size_t i) { return Eigen::MatrixXd(observations_[i]->values); });
  set_num_residuals(static_cast<int>(model.shapes()) + 1);
  mutable_parameter_block_sizes()->push_back(static_cast<int32_t>(model.shapes()));
}

template <typename Of>
Eigen::MatrixXd EliminatedResidual::outside(Eigen::Index columns, Of&& of_observation) const {
  Eigen::MatrixXd out(rows_, columns);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < observations_.size(); ++i) {
    auto rows = out.middleRows(row, observations_[i]->values.size());
    rows = of_observation(i);
    noise_[i].whiten(rows);
    row += rows.rows();
  }
  out = nuisances_.beside(std::move(out));
  project_out(fixed_, out);
  return out;
}

EliminatedResidual::Moving EliminatedResidual::project(const Eigen::VectorXd& shapes) const {
  Eigen::Index count = 0, next = 0;
  for (const ModelTerm* term : moving_) count += term->effect->amplitudes();
  Moving out;
  out.columns.resize(rows_, count);
  for (const ModelTerm* term : moving_) {
    const Eigen::Index a = term->effect->amplitudes();
    out.columns.middleCols(next, a) = outside(a, [&](std::size_t i) {
      return low_band_columns(model_, *term, *observations_[i], shapes_of(*term, shapes));
    });
    next += a;
  }
  const LeastSquares best = least_squares(out.columns, residual_);
  out.amplitudes = best.values;
  out.residual = residual_ - out.columns * best.values;
  return out;
}

bool EliminatedResidual::Evaluate(const double* const* parameters, double* residuals,
                                  double** jacobians) const {
  Eigen::VectorXd shapes(model_.shapes());
  for (const ModelTerm* term : moving_) {
    const std::vector<double> own = outer_shapes(*term, parameters[0] + term->first_shape);
    std::copy(own.begin(), own.end(), shapes.data() + term->first_shape);
  }
  const Moving at = project(shapes);
  Eigen::Map<Eigen::VectorXd> out(residuals, num_residuals());
  out.setZero();
  out[0] = at.residual.norm();
  if (!jacobians || !jacobians[0]) return std::isfinite(out[0]);
  const Eigen::MatrixXd basis = orthonormal(at.columns);
  Eigen::MatrixXd slopes(rows_, model_.shapes());
  Eigen::Index next = 0;
  for (const ModelTerm* term : moving_) {
    const Eigen::Index a = term->effect->amplitudes();
    const auto own = shapes_of(*term, shapes);
    auto columns = slopes.middleCols(term->first_shape, std::ssize(own));
    columns = outside(columns.cols(), [&](std::size_t i) {
      return low_band_slopes(model_, *term, *observations_[i], own, at.amplitudes.segment(next, a));
    });
    for (std::size_t j = 0; j < own.size(); ++j)
      columns.col(static_cast<Eigen::Index>(j)) *=
          -slope_of_outer(term->effect->shapes()[j], own[j]);
    next += a;
  }
  project_out(basis, slopes);
  // Their triangle has the same products as the rows.
  Eigen::MatrixXd both(rows_, model_.shapes() + 1);
  both << slopes, at.residual;
  Eigen::MatrixXd upper = Eigen::MatrixXd::Zero(num_residuals(), both.cols());
  upper.topRows(std::min<Eigen::Index>(rows_, both.cols())) = upper_triangle(both);
  give(jacobians, 0, upper.leftCols(model_.shapes()));
  out = upper.rightCols(1);
  return out.allFinite();
}

double EliminatedResidual::cost(const Eigen::VectorXd& shapes) const {
  return 0.5 * project(shapes).residual.squaredNorm();
}

}  // namespace slideway
