#include "slideway/identify/identify.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "closure_summary.hpp"
#include "slideway/base/statistics.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/crosscheck.hpp"
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
    out.push_back({each.row, each.value / unit, each.expected / unit, height ? "um" : "urad",
                   std::string(name(each.kind))});
  return out;
}

InputSummary summarise_input(const Profile& profile) {
  InputSummary out{profile.name,
                   profile.file,
                   profile.format,
                   profile.sha256,
                   profile.setup.kind == Kind::face ? "face" : "slide",
                   profile.setup.quantity == Quantity::height ? "height" : "slope",
                   profile.role == Role::fit ? "fit" : "holdout"};
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
  return out;
}

TravelSummary summarise_travel(Lever lever, const std::vector<const Observation*>& fitted,
                               const Machine& machine) {
  TravelSummary out;
  out.lever = lever == Lever::paper ? "paper" : "split";
  out.slide_min_mm = std::numeric_limits<double>::infinity();
  out.slide_max_mm = -out.slide_min_mm;
  bool one_overhang = true;
  for (const Observation* observation : fitted) {
    const Setup& setup = observation->profile->setup;
    const SlideRange range = slide_range(*observation->profile, machine);
    out.slide_min_mm = std::min(out.slide_min_mm, range.least);
    out.slide_max_mm = std::max(out.slide_max_mm, range.greatest);
    if (setup.kind != Kind::face) continue;
    one_overhang = one_overhang && out.overhang_mm.value_or(setup.overhang_mm) == setup.overhang_mm;
    out.overhang_mm = setup.overhang_mm;
    out.spindle_position_mm = setup.spindle_position_mm;
  }
  if (!one_overhang) out.overhang_mm.reset();
  return out;
}

}  // namespace

Result summarise_data(const Problem& problem, const std::vector<Profile>& profiles) {
  Result result;
  result.title = problem.title;
  result.version = SLIDEWAY_VERSION;
  for (const Profile& profile : profiles) result.inputs.push_back(summarise_input(profile));
  result.closure = summarise_closure(profiles);
  return result;
}

Result identify(const Problem& problem, const std::vector<Profile>& profiles, Scope scope) {
  return identify(problem, profiles, fit_declared(problem, profiles), scope);
}

Result identify(const Problem& problem, const std::vector<Profile>& profiles,
                const FittedModel& declared, Scope scope) {
  Result result = summarise_data(problem, profiles);
  result.wavelet = problem.low_band.wavelet;
  result.level = problem.low_band.level;
  result.boundary = name(problem.low_band.boundary);

  const auto& [model, fit] = declared;
  FitResult summary = summarise(model, fit);
  result.travel = summarise_travel(problem.lever, fitted_observations(model), model.machine);
  for (const Observation* observation : fitted_observations(model))
    result.low_band_values += static_cast<std::size_t>(observation->values.size());
  if (scope != Scope::fit) {
    result.ranking = rank_effects(model, fit);
    result.dominant =
        dominant_effects(*result.ranking, lead_by_fit(model, fit), summary.identifiability);
  }
  if (scope == Scope::identify)
    result.squareness = check_squareness(model, problem.runout, summary);
  if (scope != Scope::rank) result.fit = std::move(summary);
  return result;
}

bool is_negative(const Result& result) {
  const auto matters = [](const UndeterminedDirection& direction) {
    return std::any_of(direction.combination.begin(), direction.combination.end(),
                       [](const auto& part) { return !fixed_by_convention(part.first); });
  };
  const bool undetermined =
      result.fit && std::any_of(result.fit->identifiability.unidentifiable.begin(),
                                result.fit->identifiability.unidentifiable.end(), matters);
  const bool inconsistent = result.squareness && result.squareness->verdict == "inconsistent";
  return undetermined || inconsistent || (result.fit && !result.fit->converged);
}

}  // namespace slideway
