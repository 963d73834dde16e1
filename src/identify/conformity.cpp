#include "slideway/identify/conformity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "form_columns.hpp"
#include "slideway/effects/catalogue.hpp"

namespace slideway {
namespace {

constexpr double kCoverage = 2.0;  // of the noise of a low-band value, which is well known

/// Whether a trace reads the face on both sides of the axis.
bool is_diameter(const Profile& profile) {
  const double center = profile.setup.center_mm;
  return profile.positions.front() < center && profile.positions.back() > center;
}

/// The rows of an observation that a fit uses.
std::vector<Eigen::Index> fitted_rows(const Observation& observation) {
  std::vector<Eigen::Index> rows;
  const auto left_out = left_out_values(observation);
  for (Eigen::Index i = 0; i < observation.values.size(); ++i)
    if (!std::ranges::binary_search(left_out, i)) rows.push_back(i);
  return rows;
}

/// A low-band value as a height in µm: the orthonormal transform scales it by sqrt(2)^level.
double micrometres(const Observation& observation) {
  return std::sqrt(static_cast<double>(observation.values.size()) /
                   static_cast<double>(observation.low_band.samples())) /
         kMicrometre;
}

/// Peak to valley in µm, after the least-squares line of a diameter, or the mean of a radius.
double peak_to_valley_um(const Observation& observation, const std::vector<Eigen::Index>& rows) {
  const Profile& profile = *observation.profile;
  Eigen::MatrixXd reference = Eigen::MatrixXd::Ones(std::ssize(profile.positions), 1);
  if (is_diameter(profile)) {
    reference.conservativeResize(Eigen::NoChange, 2);
    reference.col(1) =
        Eigen::Map<const Eigen::VectorXd>(profile.positions.data(), std::ssize(profile.positions));
  }
  const Eigen::MatrixXd line =
      Eigen::MatrixXd(observation.low_band.apply(reference))(rows, Eigen::all);
  const Eigen::VectorXd values = observation.values(rows);
  const Eigen::VectorXd rest = values - line * line.colPivHouseholderQr().solve(values);
  return (rest.maxCoeff() - rest.minCoeff()) * micrometres(observation);
}

struct Flatness {
  QuantityValue value;
  double left_out_um = 0.0;  // what the values that the fit leaves out add to it
};

Flatness flatness(const FittedModel& fitted) {
  QuantityValue out;
  double with_all = 0.0;
  const auto& observations = fitted.fit.linear.observations;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& observation = *observations[i];
    const Profile& profile = *observation.profile;
    if (profile.setup.kind != Kind::face || profile.setup.quantity != Quantity::height) continue;
    if (profile.free_tilt && !is_diameter(profile)) return {};
    std::vector<Eigen::Index> all(static_cast<std::size_t>(observation.values.size()));
    std::iota(all.begin(), all.end(), 0);
    with_all = std::max(with_all, peak_to_valley_um(observation, all));
    const std::vector<Eigen::Index> fitted_values = fitted_rows(observation);
    if (fitted_values.empty()) continue;
    const double value = peak_to_valley_um(observation, fitted_values);
    if (value <= out.value.value_or(0.0)) continue;
    const double of_value = fitted.fit.noise[i].standard_deviation() * micrometres(observation);
    out.value = value;
    out.standard_uncertainty = std::sqrt(2.0) * of_value;
    out.expanded_uncertainty = kCoverage * *out.standard_uncertainty;
    out.coverage_factor = kCoverage;
  }
  return {out, std::max(0.0, with_all - out.value.value_or(with_all))};
}

QuantityValue straightness(const ModelResult& summary) {
  if (summary.straightness)
    for (const StraightnessError& error : summary.straightness->errors)
      if (error.line == ReferenceLineKind::minimum_zone) return error;
  return {};
}

/// Peak to valley of what the model has of E_ZX under other names, µm: by how much the straightness
/// may be more or less.
double parts_beside_um(const FittedModel& fitted, const ModelResult& summary) {
  const Model& model = fitted.model;
  SlideRange travel{INFINITY, -INFINITY};
  for (const Observation* each : fitted.fit.linear.observations) {
    const SlideRange own = slide_range(*each->profile, model.machine);
    travel.least = std::min(travel.least, own.least);
    travel.greatest = std::max(travel.greatest, own.greatest);
  }
  if (!(travel.greatest > travel.least)) return 0.0;
  constexpr Eigen::Index kPoints = 2001;  // of a wave of a fiftieth of the travel, 40 a cycle
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(kPoints, travel.least, travel.greatest);
  double sum = 0.0;
  for (const ModelTerm& term : model.terms) {
    if (!is_part_of_straightness(term.effect->description()) ||
        !term.effect->applies_to(on_slide()) ||
        (summary.straightness && std::ranges::count(summary.straightness->parts, term.name) > 0))
      continue;
    const Eigen::VectorXd form =
        form_columns(model, term, shapes_of(term, fitted.fit.estimate.shapes), on_slide(), x) *
        fitted.fit.estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes());
    sum += (form.maxCoeff() - form.minCoeff()) / kMicrometre;
  }
  return sum;
}

QuantityValue squareness(const ModelResult& summary) {
  const FittedParameter* const parameter = summary.squareness();
  if (!parameter || !parameter->value) return {};
  QuantityValue out = *parameter;
  out.value = std::abs(*parameter->value) / kMicroradian;
  if (parameter->expanded_uncertainty)
    out.expanded_uncertainty = *parameter->expanded_uncertainty / kMicroradian;
  return out;
}

}  // namespace

ConformityVerdict conformity_verdict(const QuantityValue& value, double limit, double beside) {
  if (!value.value || !value.expanded_uncertainty) return ConformityVerdict::undecided;
  const double size = std::abs(*value.value), guard = *value.expanded_uncertainty + beside;
  if (size + guard <= limit) return ConformityVerdict::conforms;
  return size - guard > limit ? ConformityVerdict::does_not_conform : ConformityVerdict::undecided;
}

std::vector<Conformity> conformity_of(const Problem& problem, const FittedModel& fitted,
                                      const ModelResult& summary) {
  const auto& [flatness_um, straightness_um, squareness_um_per_m] = problem.tolerance;
  std::vector<Conformity> out;
  const auto decide = [&](const char* what, const QuantityValue& value, double limit, bool is_angle,
                          double beside = 0.0) {
    Conformity& each = out.emplace_back();
    each.what = what;
    (is_angle ? each.value_um_per_m : each.value_um) = value.value;
    (is_angle ? each.U_um_per_m : each.U_um) = value.expanded_uncertainty;
    (is_angle ? each.limit_um_per_m : each.limit_um) = limit;
    each.verdict = conformity_verdict(value, limit, beside);
  };
  if (flatness_um) {
    const auto [value, left_out_um] = flatness(fitted);
    decide(kFlatness, value, *flatness_um, false, left_out_um);
    if (left_out_um > 0.0) out.back().with_left_out_um = *value.value + left_out_um;
  }
  if (straightness_um)
    decide("straightness", straightness(summary), *straightness_um, false,
           parts_beside_um(fitted, summary));
  if (squareness_um_per_m) decide("squareness", squareness(summary), *squareness_um_per_m, true);
  return out;
}

}  // namespace slideway
