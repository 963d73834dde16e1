#include "slideway/identify/fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "face_slope.hpp"
#include "slideway/base/error.hpp"
#include "slideway/identify/departures.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"
#include "slideway/identify/planned_fit.hpp"
#include "slideway/identify/shape_grid.hpp"

namespace slideway {
namespace {

constexpr double kSettled = 1e-4;    // relative change of the noise: no estimate moves visibly
constexpr double kSameMemory = 0.1;  // of white residuals: moves -2 ln L by a few tenths at most
constexpr int kMostRounds = 6;
constexpr double kNear = 0.01;  // standard deviations of the noise: where solvers end

bool has_settled(const std::vector<Noise>& before, const std::vector<Noise>& after) {
  const auto same = [](double a, double b) { return std::abs(a - b) <= kSettled * b; };
  return std::ranges::equal(before, after, [&](const Noise& a, const Noise& b) {
    return same(a.standard_deviation(), b.standard_deviation()) &&
           same(a.long_run_deviation(), b.long_run_deviation());
  });
}

bool has_no_loss(const Model& model) {
  return std::ranges::all_of(model.observations, [](const Observation& observation) {
    return observation.profile->loss == Loss::none;
  });
}

/// Whether the sum of squares is smooth about the estimate, which is inside all bounds.
bool can_be_refined(const Model& model, const Solution& fit) {
  const auto stepwise = [](const ModelTerm& term) {
    return std::ranges::any_of(term.effect->shapes(), &Shape::stepwise);
  };
  return (fit.converged || model.shapes() == 0) &&
         std::ranges::count(fit.shape_at_bound, true) == 0 &&
         std::ranges::none_of(model.terms, stepwise) && has_no_loss(model);
}

void move(const Compressed& compressed, const Eigen::VectorXd& change, Estimate& estimate) {
  estimate.amplitudes += change.head(estimate.amplitudes.size());
  estimate.shapes += change.tail(estimate.shapes.size());
  for (std::size_t i = 0; i < compressed.profiles.size(); ++i)
    estimate.nuisances[i].head(compressed.profiles[i].levelling()) +=
        compressed.profiles[i].levelled(change);
}

Eigen::VectorXd newton_step(const Compressed& compressed, const Rank& rank) {
  return rank.basis *
         (rank.basis.transpose() * (compressed.triangle.transpose() * compressed.target));
}

/// Gauss-Newton steps as long as they become shorter. They do not look at the sum of squares: it is
/// flat at the minimum, so that its rounding hides the second half of the digits. Of a linear
/// problem: iterative refinement.
Compressed refined(const Model& model, Solution& fit) {
  const bool is_linear = model.shapes() == 0;
  constexpr double kEnough = 1e-10;      // of the noise: 10 digits where u is as large as the value
  constexpr double kLastDigits = 1e-15;  // of what the model makes
  constexpr double kShorter = 0.9;
  const int most = is_linear ? 3 : 50;
  Compressed compressed = compress(fit.linear, fit.noise);
  fit.rank = analyse_rank(compressed.triangle, compressed.scale, model.gates.rank_tolerance);
  double before = is_linear ? INFINITY : kNear;
  for (int step = 0; step < most && can_be_refined(model, fit); ++step) {
    const Eigen::VectorXd change = newton_step(compressed, fit.rank);
    const double size = (compressed.triangle * change).norm();
    if (!(size < kShorter * before)) break;
    Estimate moved = fit.estimate;
    move(compressed, change, moved);
    if (std::ranges::count(bounds_met(model, moved.shapes), true) > 0) break;
    fit.estimate = std::move(moved);
    before = size;
    settle_residuals(model, fit.estimate, fit.linear);
    Eigen::VectorXd all(change.size());
    all << fit.estimate.amplitudes, fit.estimate.shapes;
    const double enough = is_linear ? kLastDigits * (compressed.triangle * all).norm() : kEnough;
    if (!(size > enough)) break;
    compressed = compress(fit.linear, fit.noise);
    fit.rank = analyse_rank(compressed.triangle, compressed.scale, model.gates.rank_tolerance);
  }
  return compressed;
}

/// solve(); of a linear problem whose equations are too ill-conditioned for its iterations, by the
/// decomposition of its columns.
SolveSummary solved(const Model& model, const Estimate& start, Solution& fit) {
  SolveSummary out = solve(model, fit.linear, fit.noise, start);
  if (out.converged || model.shapes() > 0 || !has_no_loss(model)) return out;
  fit.estimate = std::move(out.estimate);
  const Compressed compressed = refined(model, fit);
  out.converged = (compressed.triangle * newton_step(compressed, fit.rank)).norm() <= kNear;
  out.estimate = std::move(fit.estimate);
  return out;
}

/// Per parameter: whether a convention fixes it.
std::vector<bool> conventions(const Model& model) {
  std::vector<bool> out;
  for (const ModelTerm& term : model.terms)
    for (const Parameter& each : term.effect->parameters()) out.push_back(each.by_convention);
  return out;
}

/// Moves along the null directions to where their own parameters are 0: no prediction changes.
/// Along those of conventions alone, to the least amplitudes: b_0 and b_1 at the zero of a slide
/// that is far away are large differences of large numbers.
void fix_gauge(const Model& model, const Compressed& compressed, Solution& fit) {
  if (fit.null.own.empty()) return;
  const std::vector<bool> by_convention = conventions(model);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(model.amplitudes() + model.shapes());
  auto moved = change.head(model.amplitudes());
  Eigen::MatrixXd of_conventions(model.amplitudes(), 0);
  for (std::size_t d = 0; d < fit.null.own.size(); ++d) {
    const Eigen::VectorXd along = fit.null.amplitudes.col(d).head(model.amplitudes());
    bool is_of_conventions = true;
    for (std::size_t p = 0; p < by_convention.size(); ++p)
      is_of_conventions &= by_convention[p] || fit.null.parameters(p, d) == 0.0;
    if (is_of_conventions)
      append_columns(of_conventions, along);
    else
      moved -= fit.parameters.values[fit.null.own[d]] * along;
  }
  const Eigen::MatrixXd basis = orthonormal(std::move(of_conventions));
  moved -= basis * (basis.transpose() * (fit.estimate.amplitudes + moved));
  fit.estimate.amplitudes += change.head(model.amplitudes());
  for (std::size_t i = 0; i < compressed.profiles.size(); ++i) {
    const ProfileTriangle& profile = compressed.profiles[i];
    fit.estimate.nuisances[i].head(profile.levelling()) +=
        profile.levelled(change) - profile.levelled(Eigen::VectorXd::Zero(change.size()));
  }
  fit.parameters = all_parameters(model, fit.estimate);
}

void find_null_directions(const Model& model, const Compressed& compressed, Solution& fit) {
  fit.null = null_directions(model, fit.rank, fit.parameters.jacobian,
                             parameter_scale(fit.parameters.jacobian, compressed.scale));
}

void find_uncertainty(const Model& model, const Compressed& compressed, Solution& fit) {
  const double inflation = fit.uncertainty.inflation;
  fit.uncertainty = assess(fit.linear, compressed, fit.noise, fit.rank.basis, inflation);
  fit.uncertainty.departures =
      response_to_departures(model, fit.linear, fit.noise, fit.estimate, fit.rank.basis);
  if (const Eigen::MatrixXd& changes = fit.uncertainty.departures.to_laws; changes.cols() > 0)
    fit.uncertainty.add(changes * changes.transpose(), compressed);
  if (!fit.estimate.curve) return;
  fit.uncertainty.has_curve = true;
  fit.uncertainty.add(covariance_of_curve_prior(model, fit.linear, fit.noise, fit.estimate),
                      compressed);
}

/// Rank, gauge and uncertainty at the estimate.
void conclude(const Model& model, Solution& fit) {
  const Compressed compressed = refined(model, fit);
  fit.parameters = all_parameters(model, fit.estimate);
  find_null_directions(model, compressed, fit);
  fix_gauge(model, compressed, fit);
  find_uncertainty(model, compressed, fit);
}

Eigen::MatrixXd covariance_of(const Uncertainty& uncertainty) {
  return uncertainty.inflation * uncertainty.basis * uncertainty.covariance *
         uncertainty.basis.transpose();
}

/// Whether a solution has changed the residuals by what the columns of the model make, and by so
/// little more that the noise would be found to be the same: its size as has_settled() has it, and
/// its memory. The restricted likelihood that it was found by does not see the former, unless there
/// are priors.
/// @param before     the estimate at the residuals the noise was found from
bool is_changed_by_model_alone(const Solution& fit, const Estimate& after, const Estimate& before,
                               const std::vector<Eigen::VectorXd>& residuals) {
  const Linearisation& linear = fit.linear;
  if (linear.prior_rows.rows() > 0) return false;
  Eigen::VectorXd change(after.amplitudes.size() + after.shapes.size());
  change << after.amplitudes - before.amplitudes, after.shapes - before.shapes;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    Eigen::MatrixXd white(residuals[i].size(), 3);  // before, after, what the model did not make
    white << residuals[i], linear.residuals[i], linear.residuals[i] - residuals[i];
    white.col(2).noalias() += linear.columns[i] * change;
    if (after.nuisances[i].size() > 0)
      white.col(2).noalias() +=
          linear.observations[i]->nuisances * (after.nuisances[i] - before.nuisances[i]);
    fit.noise[i].whiten(white);
    const Eigen::RowVectorXd squares = white.colwise().squaredNorm();
    const double rise = 2.0 * white.col(0).dot(white.col(2)) + squares[2];
    if (!(std::sqrt(squares[2]) <= kSameMemory) ||
        !(std::abs(rise) <= 2.0 * kSettled * squares.head(2).minCoeff()))
      return false;
  }
  return true;
}

FitNoise noise_of(const Model& model, const Linearisation& linear) {
  if (!model.complete) return noise_under(linear, model.gates);
  return {noise_if_complete(linear, noise_beside(linear, model.gates), model.gates)};
}

/// The noise under the model, and under that noise the prior of its curve.
/// @return whether both are what they were
bool settle(const Model& model, Solution& fit, Estimate& estimate,
            std::optional<CurveEstimate>& curve) {
  fit.linear.errors_of_causes = errors_of_causes(model, fit.linear, estimate);
  FitNoise noise =
      noise_of(model, curve ? beside_curve(model, fit.linear, *curve, estimate) : fit.linear);
  if (curve) {
    const double factor = noise_beside_curve(model, fit.linear, noise.profiles, estimate);
    for (Noise& each : noise.profiles) each = each.scaled(factor);
  }
  const bool settled = has_settled(fit.noise, noise.profiles);
  fit.noise = std::move(noise.profiles);
  fit.uncertainty.inflation = noise.inflation;
  if (!curve) return settled;
  curve = estimate_curve(model, fit.linear, fit.noise, estimate);
  const CurvePrior before = std::exchange(*estimate.curve, curve->prior);
  return settled && curve->prior == before;
}

/// Low-band values, and the unknowns they are to tell: without those that a convention fixes, as
/// levelling takes them.
std::pair<Eigen::Index, Eigen::Index> values_and_unknowns(const Model& model) {
  Eigen::Index values = 0, unknowns = model.amplitudes() + model.shapes();
  if (const ModelTerm* const curve = curve_term(model))
    unknowns -= curve->effect->knots()->positions_mm.size();  // they have a prior
  for (const ModelTerm& term : model.terms)
    unknowns -= std::ssize(term.priors) +
                std::ranges::count(term.effect->parameters(), true, &Parameter::by_convention);
  for (const Observation* observation : fitted_observations(model)) {
    values += observation->values.size() - observation->left_out();
    unknowns += std::ssize(observation->nuisance_names);
  }
  return {values, unknowns};
}

}  // namespace

Eigen::Index spare_values(const Model& model) {
  const auto [values, unknowns] = values_and_unknowns(model);
  return values - unknowns;
}

void require_enough_data(const Model& model) {
  const auto [values, unknowns] = values_and_unknowns(model);
  if (values == 0) throw UsageError("no profile has role = \"fit\"");
  if (values < unknowns)
    throw DataError("the profiles have " + std::to_string(values) + " low-band values for " +
                    std::to_string(unknowns) +
                    " parameters; accepted: more readings, fewer parameters (a lower degree) or a "
                    "lower level of the low band");
}

Solution fit(const Model& model, const std::optional<Eigen::VectorXd>& shapes) {
  require_enough_data(model);
  Solution out;
  out.noise = first_noise(model);
  Estimate start = initial_estimate(model, shapes);
  if (!shapes) scan_shapes(model, out.noise, start);
  out.linear = linearise(model, start);
  std::optional<CurveEstimate> curve;
  if (start.curve) {
    curve = estimate_curve(model, out.linear, out.noise, start);
    start.curve = curve->prior;
  }
  SolveSummary found = solved(model, start, out);
  for (int round = 0; round < kMostRounds; ++round) {
    if (settle(model, out, found.estimate, curve)) break;
    const std::vector<Eigen::VectorXd> residuals = out.linear.residuals;
    const Estimate before = std::move(found.estimate);
    found = solved(model, before, out);
    if (is_changed_by_model_alone(out, found.estimate, before, residuals)) break;
  }
  out.estimate = found.estimate;
  out.converged = found.converged;
  out.message = found.message;
  out.shape_at_bound = found.shape_at_bound;
  conclude(model, out);
  return out;
}

Solution with_profiles(const Model& model, const Solution& fit,
                       const std::vector<ProfileToCome>& more) {
  Solution out = fit;
  for (const ProfileToCome& profile : more) {
    const Observation& observation = *profile.observation;
    out.linear.observations.push_back(&observation);
    out.linear.columns.push_back(linear_columns(model, fit.estimate, observation));
    out.linear.residuals.emplace_back(Eigen::VectorXd::Zero(observation.values.size()));
    out.estimate.nuisances.emplace_back(Eigen::VectorXd::Zero(observation.nuisances.cols()));
    out.noise.push_back(profile.noise);
  }
  out.linear.errors_of_causes = errors_of_causes(model, out.linear, out.estimate);
  for (std::size_t i = fit.noise.size();
       i < out.noise.size() && !out.linear.errors_of_causes.empty(); ++i)
    out.noise[i].add_known(out.linear.errors_of_causes[i]);
  const Compressed compressed = compress(out.linear, out.noise);
  out.rank = analyse_rank(compressed.triangle, compressed.scale, model.gates.rank_tolerance);
  find_null_directions(model, compressed, out);
  find_uncertainty(model, compressed, out);
  if ((!fit.other_forms.empty() || !fit.other_shapes.empty()) && !more.empty()) {
    const Solution without = with_profiles(model, fit, {});
    out.uncertainty.add(covariance_of(fit.uncertainty) - covariance_of(without.uncertainty),
                        compressed);
  }
  return out;
}

FittedModel fit_model(Model model, const std::optional<Eigen::VectorXd>& shapes) {
  for (Observation& observation : model.observations)
    leave_out(observation, values_at_axis(observation, model.machine));
  Solution found = fit(model, shapes);
  bool more = false;
  std::size_t fitted = 0;
  for (Observation& observation : model.observations) {
    // A held-out profile's noise is not known: as that of the first fitted one.
    const bool is_fitted = observation.profile->role == Role::fit;
    const Noise& noise = found.noise[is_fitted ? fitted++ : 0];
    more |=
        leave_out(observation, undescribed_values(model, observation,
                                                  steep_curve(model, found.estimate, observation),
                                                  noise.standard_deviation()));
  }
  if (more) found = fit(model, found.estimate.shapes);
  model.range.face_slope = face_slope(model, found.estimate);
  if (model.range.face_slope && follow_face(model)) found = fit(model, found.estimate.shapes);
  return {std::move(model), std::move(found)};
}

FittedModel fit_as_complete(FittedModel fitted) {
  fitted.model.complete = true;
  return fit_model(std::move(fitted.model), fitted.fit.estimate.shapes);
}

void allow_for_others(const Problem& problem, FittedModel& fitted) {
  allow_for_other_form(problem, fitted);
  allow_for_other_shapes(problem, fitted);
}

FittedModel fit_declared(const Problem& problem, const std::vector<Profile>& profiles) {
  FittedModel out = fit_model(build_model(problem, profiles));
  allow_for_others(problem, out);
  return out;
}

}  // namespace slideway
