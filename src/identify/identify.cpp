#include "slideway/identify/identify.hpp"
#include "slideway/identify/low_band_lines.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "closure_summary.hpp"
#include "repeats.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/conformity.hpp"
#include "slideway/identify/crosscheck.hpp"
#include "slideway/identify/held_out.hpp"
#include "slideway/identify/noise_model.hpp"
#include "slideway/identify/ranking.hpp"

namespace slideway {
namespace {

std::vector<OutlierSummary> largest_outliers(const Profile& profile) {
  constexpr std::size_t kListed = 20;
  std::vector<OutlierRow> outliers = profile.outliers;
  const auto size = [](const OutlierRow& each) { return std::abs(each.value - each.expected); };
  std::ranges::stable_sort(outliers, std::greater<>(), size);
  outliers.resize(std::min(outliers.size(), kListed));
  std::ranges::sort(outliers, {}, &OutlierRow::row);
  const bool height = profile.setup.quantity == Quantity::height;
  const double unit = height ? kMicrometre : 1e-6;
  std::vector<OutlierSummary> out;
  for (const OutlierRow& each : outliers)
    out.push_back({each.row, each.value / unit, each.expected / unit,
                   height ? MicroUnit::um : MicroUnit::urad, each.kind});
  return out;
}

InputSummary summarise_input(const Profile& profile) {
  InputSummary out{profile.name,       profile.file,           profile.format, profile.sha256,
                   profile.setup.kind, profile.setup.quantity, profile.role};
  if (profile.loss != Loss::none) out.loss = profile.loss;
  if (profile.setup.kind == Kind::face) out.azimuth_deg = profile.setup.azimuth_deg;
  out.surface = profile.surface;
  out.instrument = profile.instrument;
  out.samples = profile.values.size();
  out.missing = profile.missing;
  out.left_out = profile.left_out;
  out.outlier_count = profile.outliers.size();
  out.outliers = largest_outliers(profile);
  out.position_min_mm = profile.positions.front();
  out.position_max_mm = profile.positions.back();
  const Statistics values = statistics_of(profile.values);
  const double spread = values.largest - values.least;
  if (profile.setup.quantity == Quantity::height) {
    out.rms_um = values.deviation / kMicrometre;
    out.pv_um = spread / kMicrometre;
  } else {
    out.rms_urad = values.deviation * 1e6;
    out.pv_urad = spread * 1e6;
  }
  out.notes = profile.notes;
  out.notes.insert(out.notes.end(), profile.doubts.begin(), profile.doubts.end());
  return out;
}

TravelSummary summarise_travel(Lever lever, const Model& model) {
  const SlideRange travel = measured_travel(model);
  TravelSummary out{lever, travel.least, travel.greatest, {}, {}};
  bool one_overhang = true;
  for (const Observation* observation : fitted_observations(model)) {
    const Setup& setup = observation->profile->setup;
    if (setup.kind != Kind::face) continue;
    one_overhang = one_overhang && out.overhang_mm.value_or(setup.overhang_mm) == setup.overhang_mm;
    out.overhang_mm = setup.overhang_mm;
    out.spindle_position_mm = setup.spindle_position_mm;
  }
  if (!one_overhang) out.overhang_mm.reset();
  return out;
}

LowBandSummary summarise_low_band(const Observation& observation) {
  const LowBandOptions& options = observation.low_band.options();
  return {observation.profile->name, options.wavelet, options.level, options.boundary,
          static_cast<std::size_t>(observation.values.size())};
}

/// What the low band of a profile will be; without values where the samples are too few.
LowBandSummary planned_low_band(const Profile& profile, const LowBandOptions& options) {
  const bool enough = (profile.positions.size() >> options.level) > 0;
  return {profile.name, options.wavelet, options.level, options.boundary,
          enough ? static_cast<std::size_t>(LowBand(options, profile.positions).values()) : 0};
}

Result summarise_inputs(const Problem& problem, const std::vector<Profile>& profiles) {
  Result result;
  result.title = problem.title;
  result.about = problem.about;
  result.version = SLIDEWAY_VERSION;
  for (const Profile& profile : profiles) {
    result.inputs.push_back(summarise_input(profile));
    for (const std::string& doubt : profile.doubts)
      result.notes.push_back(profile.name + ": " + doubt);
  }
  result.notes.insert(result.notes.end(), problem.remarks.begin(), problem.remarks.end());
  result.assumed = assumptions(problem, profiles);
  result.closure = summarise_closure(profiles);
  return result;
}

bool is_disagreement(const ProfileCheck& check) {
  return check.verdict == Consistency::inconsistent;
}

/// The amplitudes of waves that are too fine for the low band of a profile, but for feed marks.
std::vector<Eigen::Index> amplitudes_of_fine_waves(const Model& model, const Solution& fit) {
  std::vector<Eigen::Index> out;
  for (const ModelTerm& term : model.terms) {
    if (!term.effect->description().kinematic &&
        is_too_fine(model, term, shapes_of(term, fit.estimate.shapes), fit.linear.observations))
      for (int a = 0; a < term.effect->amplitudes(); ++a) out.push_back(term.first_amplitude + a);
  }
  return out;
}

/// What estimates without one profile each differ by: all of them where profiles disagree, else
/// those of waves that are too fine, which the nose of the tool makes smaller in one cut than in
/// another. No columns: none.
Eigen::MatrixXd scatter_between_profiles(const Model& model, const Solution& fit,
                                         bool profiles_disagree) {
  const std::vector<Eigen::Index> fine = amplitudes_of_fine_waves(model, fit);
  if (fit.linear.observations.size() < 2 || (!profiles_disagree && fine.empty())) return {};
  Eigen::MatrixXd all = scatter_of_profiles(fit, model.gates);
  if (profiles_disagree) return all;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(all.rows(), all.cols());
  for (const Eigen::Index a : fine) out.row(a) = all.row(a);
  return out;
}

void rank(const FittedModel& fitted, const ModelResult& summary, Result& result) {
  const auto& [model, fit] = fitted;
  result.ranking = rank_effects(model, fit);
  result.dominant = dominant_effects(result.ranking, lead_by_fit(model, fit),
                                     summary.identifiability, model.gates);
}

}  // namespace

Result summarise_data(const Problem& problem, const std::vector<Profile>& profiles) {
  Result result = summarise_inputs(problem, profiles);
  for (const Profile& profile : profiles)
    result.low_band.push_back(planned_low_band(profile, problem.low_band_of(profile)));
  return result;
}

Result identify(const Problem& problem, const std::vector<Profile>& profiles, Scope scope) {
  return identify(problem, profiles, fit_declared(problem, profiles), scope);
}

Result identify_declared(const Problem& problem, const std::vector<Profile>& profiles,
                         const FittedModel& declared, Scope scope, bool with_budget) {
  Result result = summarise_inputs(problem, profiles);
  const auto& [model, fit] = declared;
  for (const Observation& observation : model.observations)
    result.low_band.push_back(summarise_low_band(observation));
  ModelResult summary = summarise(model, fit, {}, with_budget);
  result.travel = summarise_travel(problem.lever, model);
  if (scope == Scope::rank) {
    rank(declared, summary, result);
  } else {
    result.declared = std::move(summary);
  }
  return result;
}

Result identify(const Problem& problem, const std::vector<Profile>& profiles,
                const FittedModel& declared, Scope scope, bool with_budget) {
  Result result = identify_declared(problem, profiles, declared, scope, with_budget);
  if (scope == Scope::rank) return result;
  set_final(problem, declared, {}, scope, with_budget, result);
  result.declared = result.final;
  return result;
}

void set_final(const Problem& problem, const FittedModel& fitted, const MoreVariance& more,
               Scope scope, bool with_budget, Result& result) {
  const auto& [model, fit] = fitted;
  Crosscheck checks;
  MoreVariance variance = more;
  bool profiles_disagree = false;
  if (scope == Scope::identify) {
    std::vector<Noise> of_each;
    if (model.observations.size() > 1)
      of_each = model.complete ? fit.noise : noise_of_each(fit.linear, fit.noise, model.gates);
    checks.profiles = check_profiles(model, fit, of_each);
    checks.held_out = check_held_out(model, fit, of_each);
    checks.repeats = check_repeats(fit.linear, model.gates);
    profiles_disagree = std::ranges::any_of(checks.profiles, is_disagreement);
    Eigen::MatrixXd scatter = scatter_between_profiles(model, fit, profiles_disagree);
    if (scatter.size() > 0)
      variance = [more, scatter = std::move(scatter)](const Eigen::RowVectorXd& row) {
        return (row * scatter).squaredNorm() + (more ? more(row) : 0.0);
      };
  }
  ModelResult summary = summarise(model, fit, variance, with_budget);
  if (profiles_disagree)
    summary.notes.emplace_back(
        "profiles disagree: uncertainties include what the estimates without one profile each "
        "differ by");
  checks.squareness.emplace();
  if (scope == Scope::identify)
    checks.squareness = check_squareness(model, problem.runout, summary);
  else
    checks.squareness->reason = "this command makes no cross-check";
  result.crosscheck = std::move(checks);
  result.conformity = conformity_of(problem, fitted, summary);
  if (scope != Scope::fit) rank(fitted, summary, result);
  result.final = std::move(summary);
}

namespace {

bool is_inconsistent(const Crosscheck& checks) {
  return (checks.squareness && checks.squareness->verdict == Consistency::inconsistent) ||
         std::ranges::any_of(checks.profiles, is_disagreement) ||
         std::ranges::any_of(checks.held_out, [](const HeldOutCheck& check) {
           return check.verdict == HeldOutVerdict::does_not_fit;
         });
}

}  // namespace

bool is_negative(const Result& result) {
  if (is_inconsistent(result.crosscheck)) return true;
  if (!result.final) return false;
  return !result.final->converged || !open_directions(*result.final).empty();
}

std::vector<const UndeterminedDirection*> open_directions(const ModelResult& model) {
  std::vector<const UndeterminedDirection*> out;
  for (const UndeterminedDirection& direction : model.identifiability.unidentifiable)
    if (!std::ranges::all_of(direction.combination,
                             [](const auto& part) { return fixed_by_convention(part.first); }))
      out.push_back(&direction);
  return out;
}

}  // namespace slideway
