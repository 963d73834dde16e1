#include "slideway/identify/solve.hpp"

#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "residual.hpp"
#include "slideway/identify/shape_grid.hpp"

namespace slideway {
namespace {

/// Scans each shape over its range, the linear part optimal at every point; one shape after the
/// other.
void scan_shapes(const Residual& residual, const Model& model, Eigen::VectorXd& shapes) {
  for (const auto& [term, which] : residual.shapes()) {
    double& shape = shapes[term->first_shape + which];
    double best_cost = INFINITY, best = shape;
    for (const double value : shape_grid(model, *term, which)) {
      shape = value;
      double cost = 0.0;
      static_cast<void>(residual.linear_optimum(shapes, &cost));
      if (cost < best_cost) best_cost = cost, best = shape;
    }
    shape = best;
  }
}

void bound_shapes(const Residual& residual, ceres::Problem& problem, double* x) {
  const Eigen::Index first = residual.size() - static_cast<Eigen::Index>(residual.shapes().size());
  for (std::size_t s = 0; s < residual.shapes().size(); ++s) {
    const auto& [term, which] = residual.shapes()[s];
    const Shape& kind = term->effect->shapes()[which];
    const Parameter& parameter = term->effect->parameters()[kind.parameter];
    const int index = static_cast<int>(first + static_cast<Eigen::Index>(s));
    if (std::isfinite(parameter.lower) && !(kind.logarithmic && parameter.lower <= 0.0))
      problem.SetParameterLowerBound(x, index, kind.inner(parameter.lower));
    if (std::isfinite(parameter.upper))
      problem.SetParameterUpperBound(x, index, kind.inner(parameter.upper));
  }
}

ceres::Solver::Options solver_options(bool linear) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 200;
  // Ceres' defaults end a damped solve a good part of a standard error away from the minimum.
  options.function_tolerance = 1e-16;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.max_trust_region_radius = 1e32;
  if (linear) options.initial_trust_region_radius = 1e16;  // one undamped step is the solution
  return options;
}

std::vector<bool> bounds_met(const Residual& residual, const Estimate& estimate) {
  std::vector<bool> out;
  for (const auto& [term, which] : residual.shapes()) {
    const Parameter& parameter =
        term->effect->parameters()[term->effect->shapes()[which].parameter];
    const double value = estimate.shapes[term->first_shape + which];
    const double near = 1e-9 * std::max(1.0, std::abs(value));
    out.push_back(value - parameter.lower < near || parameter.upper - value < near);
  }
  return out;
}

void run_ceres(const Residual& residual, Eigen::VectorXd& x, SolveSummary& out) {
  ceres::Problem::Options keep;
  keep.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(keep);
  problem.AddResidualBlock(const_cast<Residual*>(&residual), nullptr, x.data());
  bound_shapes(residual, problem, x.data());
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(residual.shapes().empty()), &problem, &summary);
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  out.message = summary.message;
}

}  // namespace

Estimate initial_estimate(const Model& model, const std::optional<Eigen::VectorXd>& shapes) {
  Estimate start;
  start.amplitudes = Eigen::VectorXd::Zero(model.amplitudes());
  start.shapes.resize(model.shapes());
  if (shapes) start.shapes = *shapes;
  for (const ModelTerm& term : model.terms)
    for (int s = 0; !shapes && s < static_cast<int>(term.effect->shapes().size()); ++s) {
      const std::vector<double> grid = shape_grid(model, term, s);
      start.shapes[term.first_shape + s] = grid[grid.size() / 2];
    }
  for (const Observation* observation : fitted_observations(model))
    start.nuisances.emplace_back(Eigen::VectorXd::Zero(observation->nuisances.cols()));
  return start;
}

SolveSummary solve(const Model& model, Linearisation& linear, const std::vector<double>& weights,
                   const Estimate& start, bool scan) {
  Estimate zero = start;  // residuals of the linear part are counted from zero amplitudes
  zero.amplitudes.setZero();
  for (Eigen::VectorXd& nuisances : zero.nuisances) nuisances.setZero();
  relinearise(model, zero, linear);
  const Residual residual(model, linear, weights, start);
  Eigen::VectorXd shapes = start.shapes;
  if (scan) scan_shapes(residual, model, shapes);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(residual.size());
  if (!residual.shapes().empty()) x = residual.linear_optimum(shapes, nullptr);
  SolveSummary out;
  out.converged = true;
  if (residual.size() > 0) run_ceres(residual, x, out);
  out.estimate = residual.estimate(x);
  out.shape_at_bound = bounds_met(residual, out.estimate);
  refit_nuisances(model, out.estimate, linear);
  if (residual.shapes().empty() && residual.size() > 0) {  // iterative refinement
    const Residual rest(model, linear, weights, start);
    out.estimate.amplitudes += rest.estimate(rest.linear_optimum(shapes, nullptr)).amplitudes;
    refit_nuisances(model, out.estimate, linear);
  }
  return out;
}

}  // namespace slideway
