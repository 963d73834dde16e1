#include "shown.hpp"

#include <algorithm>
#include <cmath>

#include "dictionary.hpp"
#include "search.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

ModelTerm term_of(const Model& model, const std::string& name, const EffectOptions& options) {
  return {term_name(name, options.profiles),
          make_effect(name, options, model.machine, model.range),
          {}};
}

/// What each of some parameters does to the low band of a profile, one column each.
Eigen::MatrixXd images(const Model& model, const ModelTerm& term, const std::vector<Prior>& values,
                       const Observation& observation) {
  const Eigen::MatrixXd columns = low_band_columns(model, term, observation, {});
  Eigen::VectorXd of_parameters(std::ssize(values));
  for (std::size_t p = 0; p < values.size(); ++p)
    of_parameters[static_cast<Eigen::Index>(p)] = values[p].value;
  return columns * term.effect->from_parameters(of_parameters).asDiagonal();
}

/// What the low band of a profile shows beside the model.
struct Beside {
  Eigen::MatrixXd images, whole;
  Eigen::VectorXd values;
  double degrees = 0.0;              // of freedom of the values
  double before = 0.0, after = 0.0;  // square of what is faster than slow cosines, without and with

  Beside(const Model& model, const Estimate& estimate, const Observation& observation,
         const Eigen::MatrixXd& of_parts, const Eigen::MatrixXd& of_whole) {
    const Eigen::Index n = observation.values.size(), parts = of_parts.cols();
    const Eigen::MatrixXd linear = linear_columns(model, estimate, observation);
    Eigen::MatrixXd all(n, parts + of_whole.cols() + 1 + linear.cols());
    all << of_parts, of_whole, observation.values, linear;
    all = levelled(observation, std::move(all));
    const Eigen::MatrixXd form = orthonormal(all.rightCols(linear.cols()));
    all -= form * (form.transpose() * all).eval();
    images = all.leftCols(parts);
    whole = all.middleCols(parts, of_whole.cols());
    values = all.col(parts + of_whole.cols());
    const Eigen::MatrixXd slow =
        orthonormal(levelled(observation, slow_cosines(n, slow_cosine_count(n, model.gates))));
    const auto fast_square = [&](Eigen::VectorXd of) {
      of -= slow * (slow.transpose() * of).eval();
      return of.squaredNorm();
    };
    before = fast_square(values);
    after = fast_square(values - images.rowwise().sum());
    degrees = static_cast<double>(n - observation.left_out() - form.cols() -
                                  std::ssize(observation.nuisance_names));
  }
};

/// The harmonics whose image in the low band is not below its noise; none where they are the lesser
/// part of what is fast there, or the effect without options takes as much.
std::vector<std::size_t> seen_in(const Beside& beside) {
  std::vector<std::size_t> out;
  if (beside.degrees < 1.0) return out;
  const double before = beside.values.squaredNorm(),
               after = (beside.values - beside.images.rowwise().sum()).squaredNorm(),
               noise = after / beside.degrees;
  const double by_whole =
      (orthonormal(beside.whole).transpose() * beside.values).squaredNorm() -
      noise * static_cast<double>(beside.whole.cols()) * std::log(beside.degrees);
  if (beside.after > 0.5 * beside.before || before - after < by_whole) return out;
  for (Eigen::Index h = 0; 2 * h < beside.images.cols(); ++h)
    if (beside.images.middleCols(2 * h, 2).squaredNorm() >= noise)
      out.push_back(static_cast<std::size_t>(h));
  return out;
}

std::optional<ShownEffect> shown_in(const FittedModel& declared, const std::string& name,
                                    const Observation& observation) {
  const Model& model = declared.model;
  const Profile& profile = *observation.profile;
  const Effect& effect = specimen(name);
  if (!effect.applies_to(profile.setup) || !effect.lacking(profile.setup).empty())
    return std::nullopt;
  const auto seen =
      effect.shown_by(profile.stations(model.machine), profile.values, model.gates.false_line);
  if (!seen) return std::nullopt;
  EffectOptions options = seen->options, whole;
  options.profiles = whole.profiles = {profile.name};
  const Beside beside(model, declared.fit.estimate, observation,
                      images(model, term_of(model, name, options), seen->values, observation),
                      low_band_columns(model, term_of(model, name, whole), observation, {}));
  ShownEffect out{{name, whole, {}}, seen->p_value};
  for (const std::size_t h : seen_in(beside)) {
    out.effect.options.harmonics.push_back(options.harmonics[h]);
    out.effect.priors.push_back(seen->values[2 * h]);
    out.effect.priors.push_back(seen->values[2 * h + 1]);
  }
  if (out.effect.priors.empty()) return std::nullopt;
  return out;
}

constexpr double kVisible = 0.25;  // of the noise of a value: several of them show together

/// Leaves out the values into which the low band carries what the first and the last turn leave at
/// the rim and at the axis: as much as the marks, within one feed, by more than kVisible of the
/// noise. A wavelet of many taps carries it further than one value. @return true if there are any
bool leave_out_ends(FittedModel& fitted, const ShownEffect& shown) {
  Model& model = fitted.model;
  const auto at = std::ranges::find_if(model.observations, [&](const Observation& each) {
    return each.profile->name == shown.effect.options.profiles.front();
  });
  const Setup& setup = at->profile->setup;
  const double feed = *setup.feed_mm_per_min / *setup.spindle_rpm;
  double depth = 0.0;
  for (const Prior& prior : shown.effect.priors) depth += kMicrometre * std::abs(prior.value);
  const Stations stations = at->profile->stations(model.machine);
  Eigen::MatrixXd ends = Eigen::MatrixXd::Zero(stations.size(), 1);
  for (Eigen::Index i = 0; i < stations.size(); ++i)
    if (const double r = stations.radius(i); r <= feed || r >= *setup.cut_radius_mm - feed)
      ends(i, 0) = depth;
  const Eigen::VectorXd carried = at->low_band.apply(ends);
  const auto& fitted_profiles = fitted.fit.linear.observations;
  const auto place = std::ranges::find(fitted_profiles, &*at) - fitted_profiles.begin();
  const double noise = fitted.fit.noise[static_cast<std::size_t>(place)].standard_deviation();
  ValueIndices out;
  for (Eigen::Index i = 0; i < carried.size(); ++i)
    if (std::abs(carried[i]) > kVisible * noise) out.push_back(i);
  return static_cast<double>(out.size()) <
             model.gates.most_lost * static_cast<double>(carried.size()) &&
         leave_out(*at, out);
}

TraceRound round_of(const ShownEffect& shown, const FittedModel& without, const FittedModel& with) {
  const ModelResult before = summarise(without.model, without.fit),
                    after = summarise(with.model, with.fit);
  TraceRound out;
  out.accepted = shown.effect.name;
  out.profiles = shown.effect.options.profiles;
  out.before_rms_um = before.rms_um;
  out.after_rms_um = after.rms_um;
  out.before_rms_urad = before.rms_urad;
  out.after_rms_urad = after.rms_urad;
  out.p_value = shown.p_value;
  const Whitened data(without.fit.linear, with.fit.noise);
  const Projection own = project(data, stacked_columns(without.model, with.model.terms.back(), {},
                                                       data.rows() - data.values()));
  out.delta_bic = penalty(data, own.rank) - own.gain;
  return out;
}

}  // namespace

std::vector<ShownEffect> shown_by_samples(const Problem& problem, const FittedModel& declared) {
  std::vector<ShownEffect> out;
  for (const std::string& name : problem.trace.candidates) {
    if (std::ranges::count(problem.effects, name, &DeclaredEffect::name) > 0) continue;
    for (const Observation* observation : declared.fit.linear.observations)
      if (auto shown = shown_in(declared, name, *observation)) out.push_back(*std::move(shown));
  }
  return out;
}

ShownModel with_shown(const FittedModel& declared, const std::vector<ShownEffect>& shown) {
  std::vector<TraceRound> rounds;
  std::optional<FittedModel> last;
  for (const ShownEffect& each : shown) {
    const FittedModel& without = last ? *last : declared;
    Model model = without.model;
    append_term(model, each.effect, model.range);
    FittedModel with = fit_model(std::move(model));
    if (leave_out_ends(with, each)) with = fit_model(std::move(with.model));
    rounds.push_back(round_of(each, without, with));
    last.emplace(std::move(with));
  }
  return {*std::move(last), std::move(rounds)};
}

}  // namespace slideway
