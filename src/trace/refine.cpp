#include "refine.hpp"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

constexpr double kSamePlace = 1e-6;  // of what is scanned: both halves of a diameter are one

constexpr int kRounds = 3;  // between stepwise and smooth shapes, where there are both

/// The residual outside model and candidate as a function of some of its shapes, in their inner
/// scale.
class ProjectedResidual final : public ceres::CostFunction {
 public:
  ProjectedResidual(const Model& model, const Whitened& data, const ModelTerm& term,
                    std::vector<double> shape, std::vector<std::size_t> moving)
      : model_(model),
        data_(data),
        term_(term),
        shape_(std::move(shape)),
        moving_(std::move(moving)) {
    set_num_residuals(static_cast<int>(data.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(moving_.size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    std::vector<double> shape = shape_;
    for (std::size_t j = 0; j < moving_.size(); ++j)
      shape[moving_[j]] = term_.effect->shapes()[moving_[j]].outer(parameters[0][j]);
    const Eigen::Index priors = data_.rows() - data_.values();
    const Eigen::MatrixXd columns = data_.outside(stacked_columns(model_, term_, shape, priors));
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(columns);
    const Eigen::VectorXd amplitudes = decomposition.solve(data_.residual());
    Eigen::Map<Eigen::VectorXd> out(residuals, data_.rows());
    out = data_.residual() - columns * amplitudes;
    if (!jacobians || !jacobians[0]) return out.allFinite();
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::Map<RowMajor> jacobian(jacobians[0], data_.rows(), std::ssize(moving_));
    Eigen::MatrixXd slopes =
        data_.outside(stacked_slopes(model_, term_, shape, amplitudes, priors));
    slopes -= columns * decomposition.solve(slopes).eval();
    for (std::size_t j = 0; j < moving_.size(); ++j) {
      const double stretch =
          term_.effect->shapes()[moving_[j]].logarithmic ? shape[moving_[j]] : 1.0;
      jacobian.col(static_cast<Eigen::Index>(j)) =
          -stretch * slopes.col(static_cast<Eigen::Index>(moving_[j]));
    }
    return out.allFinite() && jacobian.allFinite();
  }

 private:
  const Model& model_;
  const Whitened& data_;
  const ModelTerm& term_;
  std::vector<double> shape_;
  std::vector<std::size_t> moving_;
};

/// Shapes of a kind whose neighbours on the grid leave them room.
std::vector<std::size_t> moving_shapes(const Finding& finding, bool stepwise) {
  const std::vector<Shape>& shapes = finding.candidate->term.effect->shapes();
  std::vector<std::size_t> out;
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const auto [low, high] = finding.candidate->grid.neighbours(finding.atom, s);
    if (shapes[s].stepwise == stepwise && low < high) out.push_back(s);
  }
  return out;
}

using Bounds = std::pair<double, double>;

/// Brings shapes to their best together. @param bounds  of each of `moving`
void move_shapes(const Model& model, const Whitened& data, const ModelTerm& term,
                 const std::vector<std::size_t>& moving, const std::vector<Bounds>& bounds,
                 std::vector<double>& shape) {
  ProjectedResidual cost(model, data, term, shape, moving);
  ceres::Problem::Options keep;
  keep.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(keep);
  std::vector<double> x;
  for (const std::size_t s : moving) x.push_back(term.effect->shapes()[s].inner(shape[s]));
  problem.AddResidualBlock(&cost, nullptr, x.data());
  for (std::size_t j = 0; j < moving.size(); ++j) {
    const Shape& kind = term.effect->shapes()[moving[j]];
    problem.SetParameterLowerBound(x.data(), static_cast<int>(j), kind.inner(bounds[j].first));
    problem.SetParameterUpperBound(x.data(), static_cast<int>(j), kind.inner(bounds[j].second));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-9;
  options.max_num_line_search_step_size_iterations = 0;  // a step that does not pay is refused
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t j = 0; j < moving.size(); ++j)
    shape[moving[j]] = std::clamp(term.effect->shapes()[moving[j]].outer(x[j]), bounds[j].first,
                                  bounds[j].second);  // its logarithm rounds
}

/// Brings the smooth shapes to their best together, between the neighbours on the grid, or over the
/// whole of a coarse one.
void move_smooth_shapes(const Model& model, const Whitened& data, const Finding& finding,
                        std::vector<double>& shape) {
  const std::vector<std::size_t> moving = moving_shapes(finding, false);
  if (moving.empty()) return;
  const ShapeLattice& grid = finding.candidate->grid;
  std::vector<Bounds> bounds;
  for (const std::size_t s : moving)
    bounds.push_back(finding.candidate->coarse
                         ? Bounds(grid.axes()[s].front(), grid.axes()[s].back())
                         : grid.neighbours(finding.atom, s));
  move_shapes(model, data, finding.candidate->term, moving, bounds, shape);
}

/// Frees the shapes of higher order one after the other, each with all those before it, which move
/// over the whole grid then.
void move_higher_orders(const Model& model, const Whitened& data, const Finding& finding,
                        std::vector<double>& shape) {
  const ModelTerm& term = finding.candidate->term;
  std::vector<std::size_t> moving = moving_shapes(finding, false);
  std::vector<Bounds> bounds;
  for (const std::size_t s : moving) {
    const std::vector<double>& axis = finding.candidate->grid.axes()[s];
    bounds.emplace_back(axis.front(), axis.back());
  }
  for (std::size_t s = 0; s < shape.size(); ++s) {
    const Shape& kind = term.effect->shapes()[s];
    if (!kind.higher_order) continue;
    const Parameter& parameter = term.effect->parameters()[kind.parameter];
    moving.push_back(s);
    bounds.emplace_back(parameter.lower, parameter.upper);
    move_shapes(model, data, term, moving, bounds, shape);
  }
}

/// Places between two samples of any profile, between the neighbours on the grid; first the one
/// where the shape is.
std::vector<double> places_of(const Model& model, const Finding& finding, std::size_t which,
                              double now) {
  const auto [low, high] = finding.candidate->grid.neighbours(finding.atom, which);
  std::vector<double> places{now};
  for (const Observation* observation : fitted_observations(model)) {
    const Stations stations = observation->profile->stations(model.machine);
    for (Eigen::Index i = 1; i < stations.size(); ++i) {
      const double place = 0.5 * (stations.radius(i - 1) + stations.radius(i));
      if (place > low && place < high) places.push_back(place);
    }
  }
  std::sort(places.begin() + 1, places.end());
  const double same = kSamePlace * (high - low);
  const auto is_same = [&](double a, double b) { return b - a <= same; };
  places.erase(std::unique(places.begin() + 1, places.end(), is_same), places.end());
  return places;
}

/// Brings each stepwise shape to the best place, the others held.
void move_stepwise_shapes(const Model& model, const Whitened& data, const Finding& finding,
                          std::vector<double>& shape) {
  for (const std::size_t s : moving_shapes(finding, true)) {
    double best = shape[s], largest = -1.0;
    for (const double place : places_of(model, finding, s, shape[s])) {
      shape[s] = place;
      const Projection projection = project(
          data,
          stacked_columns(model, finding.candidate->term, shape, data.rows() - data.values()));
      if (projection.gain > largest) largest = projection.gain, best = place;
    }
    shape[s] = best;
  }
}

/// Whether a smooth shape stands at an end of what the search covers that is no law of its own.
bool is_at_end(const Candidate& candidate, const std::vector<double>& shape) {
  for (std::size_t s = 0; s < shape.size(); ++s) {
    const Shape& kind = candidate.term.effect->shapes()[s];
    const std::vector<double>& axis = candidate.grid.axes()[s];
    const double first = kind.inner(axis.front()), last = kind.inner(axis.back());
    const double at = kind.inner(shape[s]);
    const double left = kind.may_begin ? last - at : std::min(at - first, last - at);
    if (!kind.stepwise && !kind.higher_order && left < 1e-6 * (last - first)) return true;
  }
  return false;
}

/// Covariance of amplitudes and shapes at the solution.
void assess(const Model& model, const Whitened& data, Refined& out) {
  const ModelTerm& term = out.candidate->term;
  const Eigen::Index a = term.effect->amplitudes();
  const auto s = static_cast<Eigen::Index>(out.shape.size());
  Eigen::MatrixXd columns(data.rows(), a + s);
  columns.leftCols(a) = out.columns;
  columns.rightCols(s) = stacked_slopes(model, term, out.shape, out.projection.amplitudes,
                                        data.rows() - data.values());
  columns = data.outside(std::move(columns));
  const Eigen::MatrixXd covariance = amplitude_covariance(columns);
  const ParameterValues values =
      term.effect->parameter_values(out.projection.amplitudes, out.shape);
  out.values = values.values;
  out.uncertainties = (values.jacobian * covariance * values.jacobian.transpose())
                          .diagonal()
                          .cwiseMax(0.0)
                          .cwiseSqrt();
  // One number for the size: the parameter itself, or for several amplitudes their joint gain.
  const int decisive = term.effect->decisive_parameter();
  out.size_in_uncertainties = term.effect->has_one_size() && out.uncertainties[decisive] > 0.0
                                  ? std::abs(out.values[decisive]) / out.uncertainties[decisive]
                                  : std::sqrt(out.projection.gain);
}

}  // namespace

Refined refine(const Model& model, const Whitened& data, const Finding& finding) {
  Refined out;
  out.candidate = finding.candidate;
  out.shape = finding.candidate->grid.points()[static_cast<std::size_t>(finding.atom)];
  const ModelTerm& term = finding.candidate->term;
  const bool both = !moving_shapes(finding, true).empty() && !moving_shapes(finding, false).empty();
  for (int round = 0; round < (both ? kRounds : 1); ++round) {
    move_stepwise_shapes(model, data, finding, out.shape);
    move_smooth_shapes(model, data, finding, out.shape);
  }
  move_higher_orders(model, data, finding, out.shape);
  out.at_end = is_at_end(*finding.candidate, out.shape);
  out.columns = stacked_columns(model, term, out.shape, data.rows() - data.values());
  out.projection = project(data, out.columns);
  out.delta_bic = finding.delta_bic + finding.gain - out.projection.gain;
  assess(model, data, out);
  return out;
}

}  // namespace slideway
