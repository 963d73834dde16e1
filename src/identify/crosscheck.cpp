#include "slideway/identify/crosscheck.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"

namespace slideway {
namespace {

constexpr double kRunoutCoverage = 2.0;
constexpr double kConsistent = 1.0;  // E_n up to here is consistent

/// Largest distance from the spindle axis any fitted face reaches, mm.
std::optional<double> travel(const Model& model) {
  std::optional<double> out;
  for (const Observation& observation : model.observations) {
    const Setup& setup = observation.profile->setup;
    if (setup.kind != Kind::face || observation.profile->role != Role::fit) continue;
    out = std::max({out.value_or(0.0), std::abs(setup.first_mm - setup.center_mm),
                    std::abs(setup.last_mm - setup.center_mm)});
  }
  return out;
}

/// Why the two disagree, as far as the numbers tell.
std::string disagreement(const SquarenessCheck& check) {
  const double fit = std::abs(*check.fit_rad), indirect = std::abs(*check.indirect_rad);
  const double ratio = std::max(fit, indirect) / std::max(std::min(fit, indirect), 1e-300);
  std::string text = "the fit and Eq. (21) differ by a factor of " + significant(ratio, 2);
  if (!check.travel_mm) return text;
  text += ": over the " + significant(*check.travel_mm, 4) + " mm that were cut, " +
          significant(indirect, 2) + " rad makes " + significant(*check.indirect_amplitude_um, 2) +
          " µm, while the face shows " + significant(*check.fit_amplitude_um, 2) + " µm";
  if (fit > indirect)
    text += "; the squareness that was measured cannot have made this face: look for another cause";
  return text;
}

}  // namespace

SquarenessCheck check_squareness(const Model& model, const std::optional<Runout>& runout,
                                 const ModelResult& fit) {
  SquarenessCheck out;
  out.travel_mm = travel(model);
  const FittedParameter* parameter = fit.squareness();
  if (parameter && parameter->identifiable) {
    out.fit_rad = parameter->value;
    out.fit_U_rad = parameter->expanded_uncertainty;
    if (out.travel_mm) out.fit_amplitude_um = std::abs(*out.fit_rad) * *out.travel_mm / kMicrometre;
  }
  if (runout) {
    out.indirect_rad = (runout->r_um + runout->p_um) * kMicrometre / runout->diameter_mm;
    out.indirect_U_rad =
        kRunoutCoverage * runout->standard_uncertainty_um * kMicrometre / runout->diameter_mm;
    if (out.travel_mm) out.indirect_amplitude_um = *out.indirect_rad * *out.travel_mm / kMicrometre;
  }
  if (!parameter) {
    out.reason = "the model declares no squareness";
  } else if (!parameter->identifiable) {
    out.reason = "these data do not determine the squareness";
  } else if (!runout) {
    out.reason = "the problem has no [runout]";
  } else if (out.fit_rad && out.fit_U_rad) {
    out.En = std::abs(std::abs(*out.fit_rad) - std::abs(*out.indirect_rad)) /
             std::hypot(*out.fit_U_rad, *out.indirect_U_rad);
    const bool consistent = *out.En <= kConsistent;
    out.verdict = consistent ? Consistency::consistent : Consistency::inconsistent;
    out.reason = consistent ? "a run-out has no sign: magnitudes are compared" : disagreement(out);
  }
  return out;
}

}  // namespace slideway
