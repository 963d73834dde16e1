#include "slideway/identify/fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "residual.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

constexpr double kRounding = 1e-13;  // a residual this small beside the data is rounding
constexpr double kSettled = 1e-6;    // relative change of weights that moves no estimate visibly
constexpr int kMaxRounds = 6;

double rms(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() /
                   static_cast<double>(std::max<Eigen::Index>(values.size(), 1)));
}

/// Weights to start with: declared, or the size of the values themselves.
std::vector<double> first_weights(const Model& model) {
  std::vector<double> weights;
  for (const Observation* observation : fitted_observations(model)) {
    const std::optional<double>& declared = observation->profile->standard_uncertainty;
    const Eigen::VectorXd rest =
        observation->values -
        observation->nuisances * fitted_nuisances(*observation, observation->values);
    const double size = rms(rest) > 0.0 ? rms(rest) : 1.0;
    weights.push_back(declared.value_or(size));
  }
  return weights;
}

void require_enough_data(const Model& model) {
  Eigen::Index values = 0, unknowns = model.amplitudes() + model.shapes();
  for (const Observation* observation : fitted_observations(model)) {
    values += observation->values.size();
    unknowns += observation->nuisances.cols();
  }
  if (values == 0) throw UsageError("no profile has role = \"fit\"");
  if (values < unknowns)
    throw DataError("the profiles have " + std::to_string(values) + " low-band values for " +
                    std::to_string(unknowns) +
                    " parameters; lower the degree or the level of the low band");
}

/// Noise of every profile at the present estimate. A residual that is only rounding has none to
/// estimate: white, of its own size.
std::vector<Noise> noise_of(const Linearisation& linear, const Eigen::MatrixXd& basis) {
  std::vector<LinearProfile> profiles;
  std::vector<Noise> noise(linear.observations.size());
  std::vector<std::size_t> measured;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    const Eigen::VectorXd& residual = linear.residuals[i];
    if (rms(residual) <= kRounding * rms(observation.values)) {
      const Eigen::Index spare =
          std::max<Eigen::Index>(residual.size() - basis.cols() - observation.nuisances.cols(), 1);
      const double size = std::sqrt(residual.squaredNorm() / static_cast<double>(spare));
      const std::optional<double>& declared = observation.profile->standard_uncertainty;
      noise[i].innovation =
          declared.value_or(std::max(size, 1e-17 * std::max(rms(observation.values), 1.0)));
      noise[i].declared = declared.has_value();
      continue;
    }
    measured.push_back(i);
    profiles.push_back({observation.nuisances, linear.columns[i] * basis, residual,
                        observation.profile->standard_uncertainty});
  }
  const Eigen::MatrixXd priors = linear.prior_rows * basis;
  const std::vector<Noise> estimated = estimate_noise(profiles, priors.transpose() * priors);
  for (std::size_t i = 0; i < measured.size(); ++i) noise[measured[i]] = estimated[i];
  return noise;
}

double largest_change(const std::vector<double>& a, const std::vector<double>& b) {
  double change = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) change = std::max(change, std::abs(a[i] / b[i] - 1.0));
  return change;
}

/// Weights matter where profiles or priors compete, or where Ceres starts from other values.
bool weights_matter(const Linearisation& linear) {
  return linear.observations.size() > 1 || linear.prior_rows.rows() > 0;
}

/// Size of one unit of each parameter in the data, for telling a coefficient from rounding.
Eigen::VectorXd parameter_scale(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& scale) {
  const Eigen::VectorXd unit = scale.unaryExpr([](double s) { return s > 0.0 ? s : 1.0; });
  const Eigen::MatrixXd inverse = (jacobian * unit.cwiseInverse().asDiagonal())
                                      .completeOrthogonalDecomposition()
                                      .pseudoInverse();
  return inverse.colwise().norm().transpose().unaryExpr([](double s) { return s > 0.0 ? s : 1.0; });
}

/// Moves along the null directions to where their own parameters are 0: no prediction changes.
void fix_gauge(const Model& model, Solution& fit) {
  for (std::size_t d = 0; d < fit.null.own.size(); ++d) {
    const double value = fit.parameters.values[fit.null.own[d]];
    fit.estimate.amplitudes -= value * fit.null.amplitudes.col(d).head(model.amplitudes());
  }
  if (fit.null.own.empty()) return;
  fit.parameters = all_parameters(model, fit.estimate);
  refit_nuisances(model, fit.estimate, fit.linear);
}

}  // namespace

Solution fit(const Model& model, const std::optional<Eigen::VectorXd>& shapes) {
  require_enough_data(model);
  Solution out;
  out.weights = first_weights(model);
  const Estimate start = initial_estimate(model, shapes);
  out.linear = linearise(model, start);
  SolveSummary solved = solve(model, out.linear, out.weights, start, !shapes);
  for (int round = 0; round < kMaxRounds; ++round) {
    const Triangle triangle = compress(out.linear, out.weights);
    out.rank = analyse_rank(triangle.matrix, triangle.scale);
    out.noise = noise_of(out.linear, out.rank.basis);
    std::vector<double> weights;
    for (const Noise& noise : out.noise) weights.push_back(noise.weight_deviation());
    const bool settled = largest_change(weights, out.weights) < kSettled;
    out.weights = weights;
    if (settled || (!weights_matter(out.linear) && model.shapes() == 0)) break;
    solved = solve(model, out.linear, out.weights, solved.estimate, false);
  }
  out.estimate = solved.estimate;
  out.converged = solved.converged;
  out.message = solved.message;
  out.shape_at_bound = solved.shape_at_bound;

  const Triangle triangle = compress(out.linear, out.weights);
  out.rank = analyse_rank(triangle.matrix, triangle.scale);
  out.parameters = all_parameters(model, out.estimate);
  out.null = null_directions(model, out.rank.null_space, out.parameters.jacobian,
                             parameter_scale(out.parameters.jacobian, triangle.scale));
  fix_gauge(model, out);
  out.uncertainty = assess(out.linear, out.weights, out.noise, out.rank.basis);
  return out;
}

FittedModel fitted(Model model, const std::optional<Eigen::VectorXd>& shapes) {
  Solution made = fit(model, shapes);
  return {std::move(model), std::move(made)};
}

FittedModel fit_declared(const Problem& problem, const std::vector<Profile>& profiles) {
  return fitted(build_model(problem, profiles));
}

}  // namespace slideway
