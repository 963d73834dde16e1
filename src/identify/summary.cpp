#include <algorithm>
#include <cmath>

#include "checks.hpp"
#include "residual.hpp"
#include "slideway/identify/fit.hpp"
#include "slideway/signal/autoregression.hpp"

namespace slideway {
namespace {

constexpr double kWorthNaming = 0.1;  // smallest |correlation| listed

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

ResidualSummary residual_summary(const Observation& observation, const Eigen::VectorXd& residual) {
  const double scale = std::sqrt(static_cast<double>(residual.size())) / per_sample(observation);
  return {observation.profile->name, observation.profile->role == Role::fit ? "fit" : "holdout",
          in_micro(observation, residual.norm() / per_sample(observation)),
          in_micro(observation, (residual.maxCoeff() - residual.minCoeff()) * scale),
          is_slope(observation) ? "urad" : "um"};
}

std::optional<double> if_finite(double number) {
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

void add_parameters(const Model& model, const Solution& fit, FitResult& out) {
  for (const ModelTerm& term : model.terms) {
    const std::vector<Parameter>& parameters = term.effect->parameters();
    for (std::size_t p = 0; p < parameters.size(); ++p) {
      const Eigen::Index index = term.first_parameter + static_cast<Eigen::Index>(p);
      FittedParameter parameter{term.name + "." + parameters[p].name, parameters[p].symbol,
                                parameters[p].unit, term.effect->description().standard_name};
      parameter.identifiable = fit.null.identifiable[index];
      if (parameter.identifiable) {
        const Spread spread = fit.uncertainty.of(fit.parameters.jacobian.row(index));
        const double factor = coverage_factor(spread.degrees_of_freedom);
        parameter.value = if_finite(fit.parameters.values[index]);
        parameter.standard_uncertainty = if_finite(spread.standard_uncertainty);
        parameter.degrees_of_freedom = spread.degrees_of_freedom;
        parameter.coverage_factor = factor;
        parameter.expanded_uncertainty = if_finite(factor * spread.standard_uncertainty);
      }
      for (std::size_t s = 0; s < term.effect->shapes().size(); ++s)
        if (term.effect->shapes()[s].parameter == static_cast<int>(p))
          parameter.at_bound = fit.shape_at_bound[term.first_shape + s];
      out.parameters.push_back(std::move(parameter));
    }
  }
}

void add_correlations(const Model& model, const Solution& fit, FitResult& out) {
  const Eigen::MatrixXd rows = fit.parameters.jacobian * fit.uncertainty.basis;
  const Eigen::MatrixXd covariance = rows * fit.uncertainty.covariance * rows.transpose();
  const std::vector<std::string> names = model.parameter_names();
  for (std::size_t i = 0; i < names.size(); ++i)
    for (std::size_t j = i + 1; j < names.size(); ++j) {
      const double scale = std::sqrt(covariance(i, i) * covariance(j, j));
      if (!fit.null.identifiable[i] || !fit.null.identifiable[j] || !(scale > 0.0)) continue;
      const double correlation = std::clamp(covariance(i, j) / scale, -1.0, 1.0);
      if (std::abs(correlation) >= kWorthNaming)
        out.correlations.emplace_back(names[i], names[j], correlation);
    }
}

void add_identifiability(const Model& model, const Solution& fit, Identifiability& out) {
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
    DeterminedCombination combination;
    for (std::size_t p = 0; p < names.size(); ++p) {
      if (rows(i, p) == 0.0) continue;
      combination.combination.emplace_back(names[p], rows(i, p));
      if (rows(i, p) == 1.0 && combination.unit.empty()) combination.unit = units[p];
    }
    const Spread spread = fit.uncertainty.of(rows.row(i) * fit.parameters.jacobian);
    combination.value = rows.row(i).dot(fit.parameters.values);
    combination.standard_uncertainty = spread.standard_uncertainty;
    combination.expanded_uncertainty =
        coverage_factor(spread.degrees_of_freedom) * spread.standard_uncertainty;
    out.determined.push_back(std::move(combination));
  }
}

void add_noise(const Solution& fit, FitResult& out) {
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Noise& noise = fit.noise[i];
    const Observation& observation = *fit.linear.observations[i];
    const auto n = static_cast<double>(observation.values.size());
    const double ratio = std::min(noise.correlation.long_run_ratio(), n);  // the trace has no more
    const double deviation =
        in_micro(observation, noise.standard_deviation() * std::sqrt(n) / per_sample(observation));
    const double step =
        (observation.profile->setup.last_mm - observation.profile->setup.first_mm) / n;
    NoiseSummary summary{observation.profile->name,
                         noise.declared    ? "declared"
                         : noise.overruled ? "estimated: the declared uncertainty is too small"
                                           : "estimated",
                         noise.correlation.order()};
    (is_slope(observation) ? summary.standard_deviation_urad : summary.standard_deviation_um) =
        deviation;
    summary.correlation_mm = noise.correlation.order() > 0 ? ratio * step : 0.0;
    summary.effective_observations = n / ratio;
    Eigen::MatrixXd whitened = fit.linear.residuals[i];
    noise.correlation.whiten(whitened);
    whitened /= noise.innovation;
    out.chi_square += whitened.squaredNorm();
    const int lags = static_cast<int>(std::clamp(n / 5.0, 1.0, 20.0));
    if (n > 2.0 * lags)
      summary.ljung_box_p = ljung_box_p_value({whitened.data(), static_cast<std::size_t>(n)}, lags,
                                              noise.correlation.order());
    out.observations += static_cast<std::size_t>(n);
    out.effective_observations += summary.effective_observations;
    out.degrees_of_freedom += n - static_cast<double>(observation.nuisances.cols());
    out.noise.push_back(std::move(summary));
  }
  out.degrees_of_freedom +=
      static_cast<double>(fit.linear.prior_rows.rows() - fit.rank.basis.cols());
}

void add_residuals(const Model& model, const Solution& fit, FitResult& out) {
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

void add_contributions(const Model& model, const Solution& fit, FitResult& out) {
  for (std::size_t i = 0; i < fit.linear.observations.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    const std::size_t first = out.contributions.size();
    double total = 0.0;
    for (const ModelTerm& term : model.terms) {
      const Eigen::Index from = term.first_amplitude, count = term.effect->amplitudes();
      Eigen::VectorXd signal = fit.linear.columns[i].middleCols(from, count) *
                               fit.estimate.amplitudes.segment(from, count);
      signal.array() -= signal.mean();
      const double size = in_micro(observation, signal.norm() / per_sample(observation));
      total += size * size;
      out.contributions.push_back({term.name, observation.profile->name, size, 0.0});
    }
    for (std::size_t c = first; c < out.contributions.size(); ++c) {
      Contribution& contribution = out.contributions[c];
      contribution.share = total > 0.0 ? contribution.rms_um * contribution.rms_um / total : 0.0;
    }
  }
}

void add_nuisances(const Solution& fit, FitResult& out) {
  for (std::size_t i = 0; i < fit.linear.observations.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    for (std::size_t j = 0; j < observation.nuisance_names.size(); ++j) {
      const bool offset = observation.nuisance_names[j] == "offset";
      const double scale = offset ? 1.0 / kMicrometre : 1.0;
      const double u = std::sqrt(std::max(fit.uncertainty.nuisance_covariances[i](j, j), 0.0));
      FittedParameter nuisance{observation.profile->name + "." + observation.nuisance_names[j],
                               observation.nuisance_names[j], offset ? "um" : "rad", ""};
      nuisance.value = fit.estimate.nuisances[i][j] * scale;
      nuisance.standard_uncertainty = u * scale;
      nuisance.expanded_uncertainty = 2.0 * u * scale;
      out.nuisances.push_back(std::move(nuisance));
    }
  }
}

}  // namespace

FitResult summarise(const Model& model, const Solution& fit) {
  FitResult out;
  out.converged = fit.converged;
  if (!fit.converged) out.message = fit.message;
  add_parameters(model, fit, out);
  add_nuisances(fit, out);
  add_correlations(model, fit, out);
  add_identifiability(model, fit, out.identifiability);
  add_noise(fit, out);
  add_residuals(model, fit, out);
  add_contributions(model, fit, out);
  add_checks(model, fit, out);
  return out;
}

const FittedParameter* FitResult::find(const std::string& name) const {
  for (const FittedParameter& parameter : parameters)
    if (parameter.name == name) return &parameter;
  return nullptr;
}

}  // namespace slideway
