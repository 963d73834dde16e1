#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "reported.hpp"
#include "residual.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/budget.hpp"
#include "slideway/identify/straightness.hpp"
#include "slideway/signal/correlation.hpp"

namespace slideway {
namespace {

constexpr int kMemoryParameters = 2;  // size and length, or size and slope
constexpr double kCancelled = 1e-12;  // of its terms: a sum that is rounding

bool is_slope(const Observation& observation) {
  return observation.profile->setup.quantity == Quantity::slope;
}

/// mm to µm, rad to µrad.
double in_micro(const Observation& observation, double value) {
  return is_slope(observation) ? value / kMicroradian : value / kMicrometre;
}

/// A low-band value as a height (or slope): the orthonormal transform scales it by sqrt(2)^level.
double per_sample(const Observation& observation) {
  return std::sqrt(static_cast<double>(observation.low_band.samples()));
}

/// A size in the member of its unit.
void set_size(const Observation& observation, double size, std::optional<double>& um,
              std::optional<double>& urad) {
  (is_slope(observation) ? urad : um) = in_micro(observation, size);
}

ResidualSummary residual_summary(const Observation& observation, const Eigen::VectorXd& residual) {
  const double scale = std::sqrt(static_cast<double>(residual.size())) / per_sample(observation);
  ResidualSummary out{observation.profile->name, observation.profile->role};
  set_size(observation, residual.norm() / per_sample(observation), out.rms_um, out.rms_urad);
  set_size(observation, (residual.maxCoeff() - residual.minCoeff()) * scale, out.pv_um,
           out.pv_urad);
  return out;
}

/// "µm, slope: µrad" as the fitted readings that show the term have it.
std::string unit_in(const std::string& unit, const Solution& fit, const ModelTerm& term) {
  constexpr std::string_view kOfSlopes = ", slope: ";
  const std::size_t at = unit.find(kOfSlopes);
  if (at == std::string::npos) return unit;
  bool heights = false, slopes = false;
  for (const Observation* observation : fit.linear.observations) {
    const Setup& setup = observation->profile->setup;
    if (term.acts_on(*observation->profile) && term.effect->applies_to(setup))
      (setup.quantity == Quantity::slope ? slopes : heights) = true;
  }
  if (heights == slopes) return unit;
  return heights ? unit.substr(0, at) : unit.substr(at + kOfSlopes.size());
}

void add_parameters(const Model& model, const Reported& reported, ModelResult& out) {
  const Solution& fit = reported.solution();
  for (const ModelTerm& term : model.terms) {
    out.effects.push_back(term.name);
    const std::vector<Parameter>& parameters = term.effect->parameters();
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const Eigen::Index index = term.first_parameter + static_cast<Eigen::Index>(p);
      FittedParameter parameter;
      parameter.name = term.name + "." + parameters[p].name;
      parameter.symbol = parameters[p].symbol;
      parameter.unit = unit_in(parameters[p].unit, fit, term);
      parameter.standard_name = term.effect->description().standard_name;
      parameter.identifiable = fit.null.identifiable[index];
      if (parameter.identifiable)
        reported.set(fit.parameters.values[index], fit.parameters.jacobian.row(index), 1.0,
                     parameter);
      for (std::size_t s = 0; s < term.effect->shapes().size(); ++s)
        if (term.effect->shapes()[s].parameter == static_cast<int>(p))
          parameter.at_bound = fit.shape_at_bound[term.first_shape + s];
      out.parameters.push_back(std::move(parameter));
    }
  }
}

void add_correlations(const Model& model, const Solution& fit, ModelResult& out) {
  const Eigen::MatrixXd rows = fit.parameters.jacobian * fit.uncertainty.basis;
  const Eigen::MatrixXd covariance = rows * fit.uncertainty.covariance * rows.transpose();
  const std::vector<std::string> names = model.parameter_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      if (!fit.null.identifiable[i] || !fit.null.identifiable[j] || !(scale > 0.0)) continue;
      const double correlation = std::clamp(covariance(i, j) / scale, -1.0, 1.0);
      if (std::abs(correlation) >= model.gates.listed_correlation)
        out.correlations.emplace_back(names[i], names[j], correlation);
    }
}

void add_identifiability(const Model& model, const Reported& reported, Identifiability& out) {
  const Solution& fit = reported.solution();
  const std::vector<std::string> names = model.parameter_names();
  out.parameters = names.size();
  out.rank = names.size() - fit.null.own.size();
  out.condition = fit.rank.condition;
  out.unidentifiable = undetermined(model, fit.null);
  std::vector<std::string> units;
  for (const ModelTerm& term : model.terms)
    for (const Parameter& parameter : term.effect->parameters()) units.push_back(parameter.unit);
  const Eigen::MatrixXd rows = determined_rows(fit.null);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::RowVectorXd of_estimate = rows.row(i) * fit.parameters.jacobian;
    const Eigen::RowVectorXd terms = rows.row(i).cwiseAbs() * fit.parameters.jacobian.cwiseAbs();
    const Eigen::MatrixXd& basis = fit.rank.basis;
    if ((of_estimate * basis).norm() <= kCancelled * (terms * basis.cwiseAbs()).norm()) continue;
    DeterminedCombination combination;
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (rows(i, p) == 0.0) continue;
      combination.combination.emplace_back(names[p], rows(i, p));
      if (rows(i, p) == 1.0 && combination.unit.empty()) combination.unit = units[p];
    }
    reported.set(rows.row(i).dot(fit.parameters.values), of_estimate, 1.0, combination);
    out.determined.push_back(std::move(combination));
  }
}

void add_noise(const Solution& fit, ModelResult& out) {
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Noise& noise = fit.noise[i];
    const Observation& observation = *fit.linear.observations[i];
    const auto n = static_cast<double>(observation.values.size());
    const double used = n - static_cast<double>(observation.left_out());
    const double step =
        (observation.profile->setup.last_mm - observation.profile->setup.first_mm) / n;
    NoiseSummary summary{observation.profile->name,
                         noise.declared    ? NoiseScaling::declared
                         : noise.overruled ? NoiseScaling::refuted
                                           : NoiseScaling::estimated,
                         !noise.is_white(), noise.unlike_sisters};
    set_size(observation, noise.standard_deviation() * std::sqrt(n) / per_sample(observation),
             summary.standard_deviation_um, summary.standard_deviation_urad);
    summary.effective_observations = std::max(1.0, noise.effective_values() * used / n);
    summary.correlation_mm = !noise.is_white() ? n / noise.effective_values() * step : 0.0;
    Eigen::MatrixXd whitened = fit.linear.residuals[i];
    noise.whiten(whitened);
    out.chi_square += whitened.squaredNorm();
    const int lags = static_cast<int>(std::clamp(n / 5.0, 1.0, 20.0));
    if (n > 2.0 * lags)
      summary.ljung_box_p = ljung_box_p_value({whitened.data(), static_cast<std::size_t>(n)}, lags,
                                              noise.is_white() ? 0 : kMemoryParameters);
    out.observations += static_cast<std::size_t>(used);
    out.effective_observations += summary.effective_observations;
    out.degrees_of_freedom += n - static_cast<double>(observation.nuisances.cols());
    out.noise.push_back(std::move(summary));
  }
  const Eigen::Index curve = fit.linear.curve_rows;
  out.degrees_of_freedom +=
      static_cast<double>(fit.linear.prior_rows.rows() - curve - fit.rank.basis.cols()) +
      (fit.linear.prior_rows.bottomRows(curve) * fit.rank.basis).squaredNorm();
}

void add_residuals(const Model& model, const Solution& fit, ModelResult& out) {
  struct Sum {
    double squares = 0.0, samples = 0.0;
    [[nodiscard]] std::optional<double> rms(double unit) const {
      if (samples == 0.0) return std::nullopt;
      return std::sqrt(squares / samples) / unit;
    }
  } heights, slopes;
  std::size_t fitted = 0;
  for (const Observation& observation : model.observations) {
    Eigen::VectorXd residual;
    if (observation.profile->role == Role::fit) {
      residual = fit.linear.residuals[fitted++];
      Sum& sum = is_slope(observation) ? slopes : heights;
      sum.squares += residual.squaredNorm();
      const auto values = static_cast<double>(observation.values.size());
      sum.samples += static_cast<double>(observation.low_band.samples()) *
                     (1.0 - static_cast<double>(observation.left_out()) / values);
    } else {
      residual = observation.values - model_values(model, observation, fit.estimate);
      if (observation.nuisances.cols() > 0)
        residual -= observation.nuisances * fitted_nuisances(observation, residual);
    }
    out.residuals.push_back(residual_summary(observation, residual));
  }
  out.rms_um = heights.rms(kMicrometre);
  out.rms_urad = slopes.rms(kMicroradian);
}

void add_contributions(const Model& model, const Solution& fit, ModelResult& out) {
  for (std::size_t i = 0; i < fit.linear.observations.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    const std::size_t first = out.contributions.size();
    const Eigen::MatrixXd columns =
        levelled(observation, fit.linear.columns[i].leftCols(model.amplitudes()));
    double total = 0.0;
    for (const ModelTerm& term : model.terms) {
      const Eigen::Index from = term.first_amplitude, count = term.effect->amplitudes();
      const Eigen::VectorXd signal =
          columns.middleCols(from, count) * fit.estimate.amplitudes.segment(from, count);
      const double size = signal.norm() / per_sample(observation);
      total += size * size;
      Contribution& contribution = out.contributions.emplace_back();
      contribution.effect = term.name;
      contribution.profile = observation.profile->name;
      contribution.share = size * size;
      set_size(observation, size, contribution.rms_um, contribution.rms_urad);
    }
    for (std::size_t c = first; c < out.contributions.size(); ++c) {
      double& share = out.contributions[c].share;
      share = total > 0.0 ? share / total : 0.0;
    }
  }
}

/// Degrees of freedom of a profile's levelling: those of its noise.
std::optional<double> levelling_freedom(const Solution& fit, std::size_t observation) {
  const Noise& noise = fit.noise[observation];
  if (!noise.is_estimated()) return std::nullopt;
  const double spread = std::max(noise.log_long_run_variance(), 1e-9);
  return std::max(1.0, std::min(noise.freedom, 2.0 / spread));
}

void add_nuisances(const Solution& fit, ModelResult& out) {
  for (std::size_t i = 0; i < fit.linear.observations.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    for (std::size_t j = 0; j < observation.nuisance_names.size(); ++j) {
      const bool offset = observation.nuisance_names[j] == "offset";
      FittedParameter nuisance;
      nuisance.name = observation.profile->name + "." + observation.nuisance_names[j];
      nuisance.symbol = observation.nuisance_names[j];
      nuisance.unit = offset ? "um" : "rad";
      const double variance = fit.uncertainty.nuisance_covariances[i](j, j);
      // Else the low band does not show it, or not to the digits there are.
      nuisance.identifiable = variance > 0.0 && std::isfinite(variance);
      if (nuisance.identifiable)
        Reported::set(fit.estimate.nuisances[i][j],
                      Spread{std::sqrt(variance), levelling_freedom(fit, i)},
                      offset ? kMicrometre : 1.0, nuisance);
      out.nuisances.push_back(std::move(nuisance));
    }
  }
}

}  // namespace

ModelResult summarise(const Model& model, const Solution& fit, const MoreVariance& more,
                      bool with_budget) {
  const Reported reported(fit, more);
  ModelResult out;
  out.converged = fit.converged;
  if (!fit.converged) out.message = fit.message;
  add_parameters(model, reported, out);
  add_nuisances(fit, out);
  add_correlations(model, fit, out);
  add_identifiability(model, reported, out.identifiability);
  add_noise(fit, out);
  add_residuals(model, fit, out);
  add_contributions(model, fit, out);
  out.straightness = identified_straightness(model, fit, more);
  if (with_budget) out.budget = uncertainty_budget(model, fit, more);
  add_checks(model, fit, out);
  return out;
}

const FittedParameter* ModelResult::find(const std::string& name) const {
  for (const FittedParameter& parameter : parameters)
    if (parameter.name == name) return &parameter;
  return nullptr;
}

const FittedParameter* ModelResult::squareness() const {
  const FittedParameter* worst = nullptr;
  double most = -INFINITY;
  for (const FittedParameter& each : parameters) {
    if (motion_error_of(each.name) != MotionError::squareness) continue;
    const double reach = each.value && each.expanded_uncertainty
                             ? std::abs(*each.value) + *each.expanded_uncertainty
                             : INFINITY;
    if (reach > most) most = reach, worst = &each;
  }
  return worst;
}

}  // namespace slideway
