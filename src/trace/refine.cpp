#include "refine.hpp"

#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>
#include <ceres/solver.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

constexpr double kSamePlace = 1e-6;  // of what is scanned: both halves of a diameter are one

/// The residual outside model and candidate as a function of the shape.
class ProjectedResidual final : public ceres::SizedCostFunction<ceres::DYNAMIC, 1> {
 public:
  ProjectedResidual(const Model& model, const Whitened& data, const ModelTerm& term)
      : model_(model), data_(data), term_(term) {
    set_num_residuals(static_cast<int>(data.rows()));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const Shape& kind = term_.effect->shapes()[0];
    const std::vector<double> shape{kind.outer(parameters[0][0])};
    const Eigen::Index priors = data_.rows() - data_.values();
    const Eigen::MatrixXd columns = data_.outside(stacked_columns(model_, term_, shape, priors));
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(columns);
    const Eigen::VectorXd amplitudes = decomposition.solve(data_.residual());
    Eigen::Map<Eigen::VectorXd> out(residuals, data_.rows());
    out = data_.residual() - columns * amplitudes;
    if (jacobians && jacobians[0]) {
      Eigen::VectorXd slope =
          data_.outside(stacked_derivatives(model_, term_, shape, priors)) * amplitudes;
      slope -= columns * decomposition.solve(slope);
      if (kind.logarithmic) slope *= shape[0];
      Eigen::Map<Eigen::VectorXd>(jacobians[0], data_.rows()) = -slope;
    }
    return out.allFinite();
  }

 private:
  const Model& model_;
  const Whitened& data_;
  const ModelTerm& term_;
};

/// Neighbours of an atom on the grid.
std::pair<double, double> neighbours(const Finding& finding) {
  const auto& shapes = finding.candidate->shapes;
  const Eigen::Index last = finding.candidate->atoms() - 1;
  return {shapes[std::max<Eigen::Index>(finding.atom - 1, 0)][0],
          shapes[std::min(finding.atom + 1, last)][0]};
}

double best_smooth_shape(const Model& model, const Whitened& data, const Finding& finding) {
  const ModelTerm& term = finding.candidate->term;
  const Shape& kind = term.effect->shapes()[0];
  const auto [low, high] = neighbours(finding);
  double x = kind.inner(finding.candidate->shapes[finding.atom][0]);
  if (!(low < high)) return kind.outer(x);
  ProjectedResidual cost(model, data, term);
  ceres::Problem::Options keep;
  keep.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(keep);
  problem.AddResidualBlock(&cost, nullptr, &x);
  problem.SetParameterLowerBound(&x, 0, kind.inner(low));
  problem.SetParameterUpperBound(&x, 0, kind.inner(high));
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-9;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return kind.outer(x);
}

/// Every place between two samples of any profile, between the neighbours on the grid.
double best_step(const Model& model, const Whitened& data, const Finding& finding) {
  const ModelTerm& term = finding.candidate->term;
  const auto [low, high] = neighbours(finding);
  std::vector<double> places{finding.candidate->shapes[finding.atom][0]};
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
  double best = places[0], largest = -1.0;
  for (const double place : places) {
    const Projection projection =
        project(data, stacked_columns(model, term, {&place, 1}, data.rows() - data.values()));
    if (projection.gain > largest) largest = projection.gain, best = place;
  }
  return best;
}

/// Covariance of amplitudes and shape at the solution.
void assess(const Model& model, const Whitened& data, Refined& out) {
  const ModelTerm& term = out.candidate->term;
  const Eigen::Index a = term.effect->amplitudes();
  const auto s = static_cast<Eigen::Index>(out.shape.size());
  Eigen::MatrixXd columns(data.rows(), a + s);
  columns.leftCols(a) = out.columns;
  if (s > 0)
    columns.col(a) = stacked_derivatives(model, term, out.shape, data.rows() - data.values()) *
                     out.projection.amplitudes;
  columns = data.outside(std::move(columns));
  const Eigen::MatrixXd covariance = amplitude_covariance(columns);
  const ParameterValues values =
      term.effect->parameter_values(out.projection.amplitudes, out.shape);
  out.values = values.values;
  out.uncertainties =
      (values.jacobian * covariance * values.jacobian.transpose()).diagonal().cwiseSqrt();
  // One number for the size: the parameter itself, or for several amplitudes their joint gain.
  out.size_in_uncertainties = term.effect->has_one_size() && out.uncertainties[0] > 0.0
                                  ? std::abs(out.values[0]) / out.uncertainties[0]
                                  : std::sqrt(out.projection.gain);
}

}  // namespace

Refined refine(const Model& model, const Whitened& data, const Finding& finding) {
  Refined out;
  out.candidate = finding.candidate;
  out.shape = finding.candidate->shapes[finding.atom];
  const ModelTerm& term = finding.candidate->term;
  if (!out.shape.empty()) {
    out.shape[0] = term.effect->shapes()[0].stepwise ? best_step(model, data, finding)
                                                     : best_smooth_shape(model, data, finding);
    const Shape& kind = term.effect->shapes()[0];
    const double first = kind.inner(finding.candidate->shapes.front()[0]);
    const double last = kind.inner(finding.candidate->shapes.back()[0]);
    const double at = kind.inner(out.shape[0]);
    out.at_end = !kind.stepwise && std::min(at - first, last - at) < 1e-6 * (last - first);
  }
  out.columns = stacked_columns(model, term, out.shape, data.rows() - data.values());
  out.projection = project(data, out.columns);
  out.delta_bic = finding.delta_bic + finding.gain - out.projection.gain;
  assess(model, data, out);
  return out;
}

}  // namespace slideway
