#include "slideway/trace/details.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/signal/bands.hpp"
#include "slideway/signal/correlation.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

constexpr std::size_t kPoints = 3000;  // of the curves of a profile
constexpr std::size_t kContributions = 900;
constexpr std::size_t kStretches = 250;  // of a wavelet band
constexpr std::size_t kMostLags = 200;
constexpr int kPerDecade = 100;  // frequencies
constexpr double kTwoSided95 = 1.96;

std::vector<double> taken(const Eigen::VectorXd& values, const std::vector<std::size_t>& indices,
                          double unit) {
  std::vector<double> out;
  out.reserve(indices.size());
  for (const std::size_t i : indices) out.push_back(values[static_cast<Eigen::Index>(i)] / unit);
  return out;
}

Eigen::VectorXd positions_of(const Profile& profile) {
  return Eigen::Map<const Eigen::VectorXd>(profile.positions.data(), std::ssize(profile.positions));
}

/// One profile in one fitted model.
class View {
 public:
  View(const FittedModel& fitted, std::size_t which)
      : fitted_(fitted), observation_(fitted.model.observations[which]) {}

  [[nodiscard]] const Observation& observation() const { return observation_; }
  [[nodiscard]] const Profile& profile() const { return *observation_.profile; }

  /// In the low band, with the levelling.
  [[nodiscard]] Eigen::VectorXd residual() const {
    return levelled(observation_.values -
                    model_values(fitted_.model, observation_, fitted_.fit.estimate));
  }

  /// The same, with what is left of the values that were left out of the fit.
  [[nodiscard]] Eigen::VectorXd whole_residual() const {
    Eigen::VectorXd rest =
        observation_.values - model_values(fitted_.model, observation_, fitted_.fit.estimate);
    const Eigen::Index levelling = std::ssize(observation_.nuisance_names);
    if (levelling > 0)
      rest -= observation_.nuisances.leftCols(levelling) *
              fitted_nuisances(observation_, rest).head(levelling);
    return rest;
  }

  [[nodiscard]] Eigen::VectorXd levelled(Eigen::VectorXd values) const {
    if (observation_.nuisances.cols() > 0)
      values -= observation_.nuisances * fitted_nuisances(observation_, values);
    return values;
  }

  /// At the samples of the profile.
  [[nodiscard]] Eigen::VectorXd full_length(const Eigen::VectorXd& low_band) const {
    const std::vector<double> grid = observation_.low_band.reconstruct(view(low_band));
    const Profile& own = profile();
    Eigen::VectorXd out(std::ssize(own.positions));
    if (!observation_.low_band.resampled())
      return Eigen::Map<const Eigen::VectorXd>(grid.data(), out.size());
    const auto last = static_cast<double>(grid.size() - 1);
    const double scale = last / (own.positions.back() - own.positions.front());
    for (Eigen::Index i = 0; i < out.size(); ++i) {
      const double place =
          std::clamp((own.positions[i] - own.positions.front()) * scale, 0.0, last);
      const auto left = std::min(static_cast<std::size_t>(place), grid.size() - 2);
      const double share = place - static_cast<double>(left);
      out[i] = (1.0 - share) * grid[left] + share * grid[left + 1];
    }
    return out;
  }

  [[nodiscard]] Eigen::VectorXd contribution(const ModelTerm& term) const {
    return effect_signal(fitted_.model, term, profile(), amplitudes(term),
                         shapes_of(term, fitted_.fit.estimate.shapes));
  }

  [[nodiscard]] Eigen::VectorXd low_band_contribution(const ModelTerm& term) const {
    const Linearisation& linear = fitted_.fit.linear;  // has the columns of what was fitted
    for (std::size_t i = 0; i < linear.columns.size(); ++i)
      if (linear.observations[i]->profile == observation_.profile)
        return linear.columns[i].middleCols(term.first_amplitude, term.effect->amplitudes()) *
               amplitudes(term);
    return low_band_columns(fitted_.model, term, observation_,
                            shapes_of(term, fitted_.fit.estimate.shapes)) *
           amplitudes(term);
  }

 private:
  [[nodiscard]] Eigen::VectorXd amplitudes(const ModelTerm& term) const {
    return fitted_.fit.estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes());
  }

  const FittedModel& fitted_;
  const Observation& observation_;
};

void add_series(const View& before, const std::optional<View>& after, double unit,
                ProfileCurves& out) {
  const Profile& profile = before.profile();
  const Eigen::VectorXd& values = before.observation().values;
  const Eigen::Map<const Eigen::VectorXd> raw(profile.values.data(), std::ssize(profile.values));
  const Eigen::VectorXd low = before.full_length(values);
  const Eigen::VectorXd rest_before = before.full_length(before.whole_residual());
  Eigen::VectorXd rest_after;
  std::vector<std::span<const double>> series{profile.values, view(low), view(rest_before)};
  if (after) {
    rest_after = after->full_length(after->whole_residual());
    series.push_back(view(rest_after));
  }
  const std::vector<std::size_t> indices = thinned(series, kPoints);
  out.position_mm = taken(positions_of(profile), indices, 1.0);
  out.raw = taken(raw, indices, unit);
  out.low_band = taken(low, indices, unit);
  out.model_before = taken(low - rest_before, indices, unit);
  out.residual_before = taken(rest_before, indices, unit);
  if (!after) return;
  out.model_after = taken(low - rest_after, indices, unit);
  out.residual_after = taken(rest_after, indices, unit);
}

void add_effects(const FittedModel& fitted, const View& last, double unit, ProfileCurves& out) {
  std::vector<Eigen::VectorXd> signals, low;
  for (const ModelTerm& term : fitted.model.terms) {
    out.effects.push_back(term.name);
    signals.push_back(last.contribution(term));
    low.push_back(last.low_band_contribution(term));
  }
  if (signals.empty()) return;
  std::vector<std::span<const double>> series;
  for (const Eigen::VectorXd& each : signals) series.push_back(view(each));
  const std::vector<std::size_t> indices =
      thinned(series, std::max(kContributions, 20 * series.size() + 2));
  out.contribution_position_mm = taken(positions_of(last.profile()), indices, 1.0);
  for (const Eigen::VectorXd& each : signals)
    out.contributions.push_back(taken(each, indices, unit));
  for (const Eigen::VectorXd& a : low) {
    std::vector<double>& row = out.correlation.emplace_back();
    for (const Eigen::VectorXd& b : low) row.push_back(pearson(view(a), view(b)));
  }
}

/// Flatness of a profile as measured, with each effect of the model taken out, and with all.
void predict_flatness(const FittedModel& fitted, const View& last,
                      std::vector<PredictedFlatness>& out) {
  const Observation& observation = last.observation();
  const bool slope = last.profile().setup.quantity == Quantity::slope;
  const double unit = slope ? kMicroradian : kMicrometre;
  const auto n = static_cast<double>(observation.values.size());
  const double per_sample = std::sqrt(static_cast<double>(observation.low_band.samples()));
  const auto predict = [&](const std::string& corrected, const Eigen::VectorXd& values) {
    const Eigen::VectorXd left = last.levelled(values) / per_sample;
    PredictedFlatness each{last.profile().name, corrected};
    (slope ? each.pv_urad : each.pv_um) = (left.maxCoeff() - left.minCoeff()) * std::sqrt(n) / unit;
    (slope ? each.rms_urad : each.rms_um) = (left.array() - left.mean()).matrix().norm() / unit;
    out.push_back(std::move(each));
  };
  if (fitted.model.terms.empty()) return;
  predict("", observation.values);
  Eigen::VectorXd all = observation.values;
  for (const ModelTerm& term : fitted.model.terms) {
    const Eigen::VectorXd low = last.low_band_contribution(term);
    predict(term.name, observation.values - low);
    all -= low;
  }
  predict("all", all);
}

Spectrum spectrum_of(const Eigen::VectorXd& residual, double step_mm, double unit) {
  Spectrum out = amplitude_spectrum(view(residual), kPerDecade);
  for (double& each : out.cycles_per_sample) each /= step_mm;
  for (double& each : out.amplitude) each /= unit;
  return out;
}

void add_residuals(const View& before, const std::optional<View>& after, double unit,
                   ProfileCurves& out) {
  const Observation& observation = before.observation();
  const auto n = static_cast<std::size_t>(observation.values.size());
  const double per_value =
      std::sqrt(static_cast<double>(observation.low_band.samples()) / static_cast<double>(n));
  out.lag_mm = (before.profile().setup.last_mm - before.profile().setup.first_mm) /
               static_cast<double>(std::max<std::size_t>(n - 1, 1));
  out.white_limit = kTwoSided95 / std::sqrt(static_cast<double>(n));
  const int lags = static_cast<int>(std::min(kMostLags, n / 4));
  const Eigen::VectorXd left = before.residual();
  out.autocorrelation_before = autocorrelation(view(left), lags);
  out.spectrum_before = spectrum_of(left / per_value, out.lag_mm, unit);
  if (!after) return;
  const Eigen::VectorXd left_after = after->residual();
  out.autocorrelation_after = autocorrelation(view(left_after), lags);
  out.spectrum_after = spectrum_of(left_after / per_value, out.lag_mm, unit);
}

void add_bands(const Observation& observation, double unit, ProfileCurves& out) {
  const LowBandOptions& options = observation.low_band.options();
  if (options.level == 0) return;
  Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(
      observation.profile->values.data(), std::ssize(observation.profile->values));
  values /= unit;
  const Bands bands =
      reconstruct_bands(daubechies(options.wavelet), options.boundary, options.level, view(values));
  for (const Band& band : bands.approximations)
    out.approximations.push_back(envelope(band, kStretches));
  for (const Band& band : bands.details) out.details.push_back(envelope(band, kStretches));
}

ProfileCurves curves_of(const FittedModel& last, const View& declared,
                        const std::optional<View>& extended) {
  const Profile& profile = declared.profile();
  const bool slope = profile.setup.quantity == Quantity::slope;
  const double unit = slope ? kMicroradian : kMicrometre;
  ProfileCurves out;
  out.profile = profile.name;
  out.role = profile.role;
  out.unit = slope ? MicroUnit::urad : MicroUnit::um;
  out.first_mm = profile.setup.first_mm;
  out.last_mm = profile.setup.last_mm;
  add_series(declared, extended, unit, out);
  add_effects(last, extended ? *extended : declared, unit, out);
  add_residuals(declared, extended, unit, out);
  add_bands(declared.observation(), unit, out);
  return out;
}

EffectInModel in_model(const ModelTerm& term, const Model& declared) {
  const Description& what = term.effect->description();
  const bool added = std::none_of(declared.terms.begin(), declared.terms.end(),
                                  [&](const ModelTerm& each) { return each.name == term.name; });
  return {what.name,
          what.standard_name,
          what.formula,
          what.source,
          what.cause,
          std::string(symbol(what.variable)),
          what.confounded_with,
          what.separated_by,
          added};
}

OptionsSummary options_of(const Problem& problem) {
  OptionsSummary out{problem.lever, problem.bodies};
  for (const DeclaredEffect& declared : problem.effects)
    for (const Prior& prior : declared.priors)
      out.priors.push_back(
          {declared.name + "." + prior.parameter, prior.value, prior.standard_uncertainty});
  out.runout = problem.runout;
  out.candidates = problem.trace.candidates;
  for (const DeclaredEffect& own : problem.trace.own)
    out.candidates.push_back(term_name(own.name, own.options.profiles));
  out.max_effects = problem.trace.max_effects;
  out.significance = problem.trace.gates.significance;
  return out;
}

}  // namespace

Details make_details(const Problem& problem, const FittedModel& before, const FittedModel* after,
                     bool with_curves) {
  const FittedModel& last = after ? *after : before;
  Details out;
  if (with_curves) out.curves.emplace();
  for (std::size_t i = 0; i < before.model.observations.size(); ++i) {
    const View declared(before, i);
    const std::optional<View> extended = after ? std::optional(View(*after, i)) : std::nullopt;
    out.setups.push_back({declared.profile().name, declared.profile().setup});
    predict_flatness(last, extended ? *extended : declared, out.what_if);
    if (out.curves) out.curves->profiles.push_back(curves_of(last, declared, extended));
  }
  for (const ModelTerm& term : last.model.terms)
    out.effects.push_back(in_model(term, before.model));
  out.options = options_of(problem);
  return out;
}

}  // namespace slideway
