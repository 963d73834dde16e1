#include "slideway/identify/solve.hpp"

#include <ceres/manifold.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <Eigen/Dense>
#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <map>

#include "residual.hpp"
#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/shape_grid.hpp"

namespace slideway {
namespace {

// One shape after the other may end in a local minimum where there are many. So many starts find
// Gauss 1 to 3 of NIST in ranges of 1.5 to 3 times their starts.
constexpr std::size_t kManyShapes = 3;
constexpr int kStarts = 8;

ceres::Solver::Options solver_options() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  options.max_num_iterations = 200;
  // 1e-9 of a sum of squares is a few thousandths of a standard error. Ceres' default ends a good
  // part of one away. Gauss-Newton steps follow where the sum is smooth.
  options.function_tolerance = 1e-9;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-13;
  options.initial_trust_region_radius = 1e16;  // one undamped step solves a linear problem
  options.max_trust_region_radius = 1e16;      // beyond it rounding moves along null directions
  options.max_num_consecutive_invalid_steps = 100;  // at the optimum a step is rounding
  // Of a step between bounds: one that does not lower the sum is refused and made shorter anyway.
  options.max_num_line_search_step_size_iterations = 0;
  return options;
}

/// Bounds of the shapes of a term within a parameter block, from `first` on.
void bound_shapes(const Model& model, const ModelTerm& term, ceres::Problem& problem, double* block,
                  int first) {
  const std::vector<Shape>& shapes = term.effect->shapes();
  for (std::size_t s = 0; s < shapes.size(); ++s) {
    const auto [lower, upper] = shape_bounds(model, term, static_cast<int>(s));
    const int index = first + static_cast<int>(s);
    if (std::isfinite(lower) && !(shapes[s].logarithmic && lower <= 0.0))
      problem.SetParameterLowerBound(block, index, shapes[s].inner(lower));
    if (std::isfinite(upper)) problem.SetParameterUpperBound(block, index, shapes[s].inner(upper));
  }
}

/// One number of a parameter block, and which of its bounds it is at.
struct AtBound {
  double* block;
  int index;
  bool lower;

  bool operator==(const AtBound& other) const {
    return block == other.block && index == other.index;
  }
};

std::vector<AtBound> at_bounds(const ceres::Problem& problem) {
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  std::vector<AtBound> out;
  for (double* const block : blocks)
    for (int i = 0; i < problem.ParameterBlockSize(block); ++i) {
      const bool lower = block[i] <= problem.GetParameterLowerBound(block, i);
      if (lower || block[i] >= problem.GetParameterUpperBound(block, i))
        out.push_back({block, i, lower});
    }
  return out;
}

/// Those held stay what they are, all others move.
void hold(const std::vector<AtBound>& held, ceres::Problem& problem) {
  std::map<double*, std::vector<int>> by_block;
  for (const AtBound& each : held) by_block[each.block].push_back(each.index);
  std::vector<double*> blocks;
  problem.GetParameterBlocks(&blocks);
  for (double* const block : blocks) {
    const int size = problem.ParameterBlockSize(block);
    const std::vector<int>& own = by_block[block];
    problem.SetParameterBlockVariable(block);
    if (static_cast<int>(own.size()) == size)
      problem.SetParameterBlockConstant(block);
    else
      problem.SetManifold(block, own.empty() ? nullptr : new ceres::SubsetManifold(size, own));
  }
}

/// Those at a bound whose sum of squares falls towards the inside.
std::vector<AtBound> pulled_inside(const std::vector<AtBound>& at, ceres::Problem& problem) {
  hold({}, problem);
  ceres::Problem::EvaluateOptions all;
  problem.GetParameterBlocks(&all.parameter_blocks);
  std::vector<double> gradient;
  std::vector<AtBound> out;
  if (!problem.Evaluate(all, nullptr, nullptr, &gradient, nullptr)) return out;
  std::size_t first = 0;
  for (const double* const block : all.parameter_blocks) {
    for (const AtBound& each : at) {
      if (each.block != block) continue;
      const double slope = gradient[first + static_cast<std::size_t>(each.index)];
      if (each.lower ? slope < 0.0 : slope > 0.0) out.push_back(each);
    }
    first += static_cast<std::size_t>(problem.ParameterBlockSize(block));
  }
  return out;
}

/// Ceres makes each step as if there were no bounds and cuts it off at them: where one is met, the
/// others end beside their best. What meets a bound is therefore held there, and let go once if
/// the best of the others pulls it inside.
ceres::Solver::Summary solve_within_bounds(const ceres::Solver::Options& options,
                                           ceres::Problem& problem) {
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  std::vector<AtBound> held, let_go;
  for (bool changed = true; changed;) {
    changed = false;
    for (const AtBound& each : at_bounds(problem))
      if (std::ranges::count(held, each) + std::ranges::count(let_go, each) == 0)
        held.push_back(each), changed = true;
    if (!changed && !held.empty())
      for (const AtBound& each : pulled_inside(held, problem)) {
        std::erase(held, each);
        let_go.push_back(each);
        changed = true;
      }
    if (!changed) break;
    hold(held, problem);
    ceres::Solve(options, &problem, &summary);
  }
  return summary;
}

struct Optimum {
  Eigen::VectorXd shapes;
  double cost = 0.0;  // half the sum of squares
};

/// The best fit near `start`, the amplitudes eliminated; Ceres then has few steps left.
Optimum eliminated_optimum(const Model& model, const Linearisation& linear,
                           const std::vector<Noise>& noise, const Eigen::VectorXd& start) {
  Eigen::VectorXd inner(start.size());
  Optimum out{Eigen::VectorXd(start.size())};
  ceres::Problem problem;
  problem.AddResidualBlock(new EliminatedResidual(model, linear, noise), nullptr, inner.data());
  for (const ModelTerm& term : model.terms) {
    const std::vector<Shape>& shapes = term.effect->shapes();
    for (std::size_t s = 0; s < shapes.size(); ++s)
      inner[term.first_shape + s] = shapes[s].inner(start[term.first_shape + s]);
    bound_shapes(model, term, problem, inner.data(), static_cast<int>(term.first_shape));
  }
  ceres::Solver::Options options = solver_options();
  options.initial_trust_region_radius = 1e4;
  out.cost = solve_within_bounds(options, problem).final_cost;
  for (const ModelTerm& term : model.terms) {
    const std::vector<double> own = outer_shapes(term, inner.data() + term.first_shape);
    std::copy(own.begin(), own.end(), out.shapes.data() + term.first_shape);
  }
  return out;
}

/// Eq. (16) as Ceres' problem: a residual block for each profile and for each prior.
class FitProblem {
 public:
  FitProblem(const Model& model, const Linearisation& at_zero, const std::vector<Noise>& noise,
             const Estimate& start)
      : unknowns_(model, start) {
    for (std::size_t i = 0; i < at_zero.observations.size(); ++i)
      add_profile(model, *at_zero.observations[i], noise[i], at_zero.columns[i], i);
    for (Unknowns::Term& each : unknowns_.terms) {
      for (const Prior& prior : each.term->priors)
        problem_.AddResidualBlock(new PriorResidual(*each.term, prior), nullptr, blocks_of(each));
      if (each.term == curve_term(model))
        problem_.AddResidualBlock(
            new CurveResidual(*each.term->effect,
                              curve_prior_rows(*each.term->effect->knots(), *start.curve)),
            nullptr, blocks_of(each));
      if (each.moves() && problem_.HasParameterBlock(each.shapes.data()))
        bound_shapes(model, *each.term, problem_, each.shapes.data(), 0);
    }
  }

  ceres::Solver::Summary solve() { return solve_within_bounds(solver_options(), problem_); }

  /// What has been found: the eliminated levelling follows from the rest.
  [[nodiscard]] Estimate estimate(const Model& model) {
    const Eigen::VectorXd amplitudes = unknowns_.estimate(model).amplitudes;
    for (const auto& [i, triangle] : eliminated_)
      unknowns_.levelling[i] = triangle.levelled(amplitudes);
    return unknowns_.estimate(model);
  }

 private:
  static std::vector<double*> blocks_of(Unknowns::Term& term) {
    if (!term.moves()) return {term.amplitudes.data()};
    return {term.amplitudes.data(), term.shapes.data()};
  }

  void add_profile(const Model& model, const Observation& observation, const Noise& noise,
                   const Eigen::MatrixXd& columns, std::size_t i) {
    const bool is_linear = model.shapes() == 0 && observation.profile->loss == Loss::none;
    std::vector<double*> blocks;
    if (!is_linear && unknowns_.levelling[i].size() > 0)
      blocks.push_back(unknowns_.levelling[i].data());
    for (Unknowns::Term& term : unknowns_.terms) {
      const std::vector<double*> own = blocks_of(term);
      blocks.insert(blocks.end(), own.begin(), own.end());
    }
    if (is_linear) eliminated_.try_emplace(i, observation, noise, columns, observation.values);
    if (blocks.empty()) return;
    if (is_linear)
      problem_.AddResidualBlock(new CompressedResidual(model, eliminated_.at(i)), nullptr, blocks);
    else
      problem_.AddResidualBlock(new ProfileResidual(model, observation, noise, columns), nullptr,
                                blocks);
  }

  Unknowns unknowns_;
  std::map<std::size_t, ProfileTriangle> eliminated_;  // per fitted observation that is linear
  ceres::Problem problem_;
};

}  // namespace

void settle_residuals(const Model& model, Estimate& estimate, Linearisation& linear) {
  for (std::size_t i = 0; i < linear.observations.size(); ++i)
    estimate.nuisances[i].tail(linear.observations[i]->left_out()).setZero();
  relinearise(model, estimate, linear);
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    const Eigen::Index count = observation.left_out();
    if (count == 0) continue;
    const auto columns = observation.nuisances.rightCols(count);
    const Eigen::VectorXd there = columns.transpose() * linear.residuals[i];
    linear.residuals[i] -= columns * there;
    estimate.nuisances[i].tail(count) = there;
  }
}

namespace {

/// The best amplitudes and levelling at the shapes of `start`, without losses, where the directions
/// that the data determine come near the cost that is possible there: else `start`.
/// @param linear  left at the result
Estimate best_at_shapes(const Model& model, const Estimate& start, double possible,
                        Linearisation& linear, const std::vector<Noise>& noise) {
  constexpr double kAsGood = 10.0;  // times what is possible: a few steps make up for it
  Estimate out = start;
  out.amplitudes.setZero();
  for (Eigen::VectorXd& each : out.nuisances) each.setZero();
  relinearise(model, out, linear);
  const Compressed compressed = compress(linear, noise);
  const Eigen::Index count = model.amplitudes();
  const Eigen::MatrixXd triangle = compressed.triangle.topLeftCorner(count, count);
  const Rank rank =
      analyse_rank(triangle, compressed.scale.head(count), model.gates.rank_tolerance);
  out.amplitudes = rank.basis * (rank.basis.transpose() *
                                 (triangle.transpose() * compressed.target.head(count)));
  Eigen::VectorXd change = Eigen::VectorXd::Zero(count + model.shapes());
  change.head(count) = out.amplitudes;
  for (std::size_t i = 0; i < compressed.profiles.size(); ++i)
    out.nuisances[i].head(compressed.profiles[i].levelling()) =
        compressed.profiles[i].levelled(change);
  settle_residuals(model, out, linear);
  double cost = 0.0;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    Eigen::VectorXd white = linear.residuals[i];
    noise[i].whiten(white);
    cost += 0.5 * white.squaredNorm();
  }
  return cost <= kAsGood * possible ? out : start;
}

/// Pseudo-values (Huber 1981): the residual of a profile with a loss as a quadratic loss would have
/// it for the same estimate and covariance, ψ(w) / mean ψ' for each white value w. Where most
/// values lie beyond what ψ rises over, they are no outliers but a profile that disagrees: they
/// count as they are.
void count_by_loss(Linearisation& linear, const std::vector<Noise>& noise) {
  constexpr double kBreakdown = 0.5;  // of the values: of any loss (Huber 1981)
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const std::unique_ptr<ceres::LossFunction> loss =
        make_loss(linear.observations[i]->profile->loss);
    if (!loss) continue;
    Eigen::VectorXd white = linear.residuals[i];
    noise[i].whiten(white);
    double slope = 0.0;
    for (double& w : white) {
      double rho[3];
      loss->Evaluate(w * w, rho);
      slope += rho[1] + 2.0 * w * w * rho[2];
      w *= rho[1];
    }
    const auto count = static_cast<double>(white.size());
    if (slope < kBreakdown * count) continue;
    white *= count / slope;
    noise[i].colour(white);
    linear.residuals[i] = std::move(white);
  }
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
  if (const ModelTerm* const curve = curve_term(model))
    start.curve = first_curve_prior(model, *curve->effect->knots());
  return start;
}

void scan_shapes(const Model& model, const std::vector<Noise>& noise, Estimate& estimate) {
  if (model.shapes() == 0) return;
  const Linearisation linear = linearise(model, estimate);
  const EliminatedResidual eliminated(model, linear, noise);
  std::vector<std::vector<double>> axes;
  for (const ModelTerm& term : model.terms)
    for (int s = 0; s < static_cast<int>(term.effect->shapes().size()); ++s)
      axes.push_back(shape_grid(model, term, s));
  // One shape after the other, until none moves: from the shapes as they are and, where several may
  // lie in each other's way, from other places of their ranges.
  const auto descend = [&](Eigen::VectorXd& shapes) {
    double least = INFINITY;
    bool moved = false;
    do {
      moved = false;
      for (std::size_t s = 0; s < axes.size(); ++s) {
        double best = shapes[s];
        for (const double value : axes[s]) {
          shapes[s] = value;
          const double cost = eliminated.cost(shapes);
          if (cost < least) least = cost, best = value, moved = true;
        }
        shapes[s] = best;
      }
    } while (moved && axes.size() > 1);
  };
  descend(estimate.shapes);
  if (axes.size() < kManyShapes) return;
  Optimum best = eliminated_optimum(model, linear, noise, estimate.shapes);
  boost::random::sobol places(axes.size());
  const auto last = static_cast<double>(places.max());
  for (int start = 0; start < kStarts; ++start) {
    Eigen::VectorXd shapes(std::ssize(axes));
    for (std::size_t s = 0; s < axes.size(); ++s)
      shapes[s] = axes[s][static_cast<std::size_t>(static_cast<double>(places()) / last *
                                                   static_cast<double>(axes[s].size() - 1))];
    descend(shapes);
    Optimum found = eliminated_optimum(model, linear, noise, shapes);
    if (found.cost < best.cost) best = std::move(found);
  }
  estimate.shapes = std::move(best.shapes);
}

SolveSummary solve(const Model& model, Linearisation& linear, const std::vector<Noise>& noise,
                   const Estimate& start) {
  SolveSummary out;
  out.estimate = start;
  if (model.shapes() > 0) {
    const Optimum optimum = eliminated_optimum(model, linear, noise, start.shapes);
    out.estimate.shapes = optimum.shapes;
    out.estimate = best_at_shapes(model, out.estimate, optimum.cost, linear, noise);
  }
  FitProblem problem(model, linear, noise, out.estimate);
  const ceres::Solver::Summary summary = problem.solve();
  out.converged = summary.termination_type == ceres::CONVERGENCE;
  out.message = summary.message;
  const std::optional<CurvePrior> curve = out.estimate.curve;
  out.estimate = problem.estimate(model);
  out.estimate.curve = curve;
  settle_residuals(model, out.estimate, linear);
  count_by_loss(linear, noise);
  out.shape_at_bound = bounds_met(model, out.estimate.shapes);
  return out;
}

}  // namespace slideway
