#include "checks.hpp"

#include <algorithm>
#include <cmath>

#include "form_columns.hpp"
#include "form_notes.hpp"
#include "noise_bounds.hpp"
#include "residual.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/reference_line.hpp"

namespace slideway {
namespace {

constexpr double kTravel = 200.0;  // mm: to which Gates::most_straightness belongs

/// Errors of all bodies at a pose, from the fitted effects.
std::vector<BodyErrors> body_errors(const Model& model, const Solution& fit, const Pose& pose,
                                    double slide) {
  std::vector<BodyErrors> errors(model.machine.bodies().size());
  for (const ModelTerm& term : model.terms)
    term.effect->add_body_errors(
        pose, slide,
        fit.estimate.amplitudes.segment(term.first_amplitude, term.effect->amplitudes()), errors);
  return errors;
}

/// Largest |exact - first order| of the volumetric error's height at the fitted values, mm.
std::optional<double> neglected_height(const Model& model, const Solution& fit) {
  std::optional<double> largest;
  for (const Observation* observation : fit.linear.observations) {
    const Setup& setup = observation->profile->setup;
    if (setup.kind != Kind::face) continue;
    const double reach = std::max(std::abs(setup.first_mm - setup.center_mm),
                                  std::abs(setup.last_mm - setup.center_mm));
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Pose pose{part * reach, setup.z_mm, setup.overhang_mm};
      const std::vector<BodyErrors> errors =
          body_errors(model, fit, pose, setup.spindle_position_mm + pose.radius);
      const double gap = model.machine.volumetric_error(pose, errors).z() -
                         model.machine.volumetric_error_first_order(pose, errors).z();
      largest = std::max(largest.value_or(0.0), std::abs(gap));
    }
  }
  return largest;
}

/// Peak to valley of a straightness about its least-squares line over the travel, mm.
double straightness_error(const Model& model, const ModelTerm& term, const Solution& fit) {
  constexpr int kPoints = 201;
  const Eigen::VectorXd x =
      Eigen::VectorXd::LinSpaced(kPoints, model.range.slide_min, model.range.slide_max);
  const Eigen::MatrixXd columns = along_slide(*term.effect, model.machine, x, Quantity::height,
                                              shapes_of(term, fit.estimate.shapes));
  return least_squares_line(
             x, columns * fit.estimate.amplitudes.segment(term.first_amplitude, columns.cols()))
      .error;
}

/// U of straightness_error(), mm; 0 where none is known.
double straightness_uncertainty(const ModelResult& out) {
  if (!out.straightness) return 0.0;
  const auto& errors = out.straightness->errors;
  const auto found =
      std::ranges::find(errors, ReferenceLineKind::least_squares, &StraightnessError::line);
  return found == errors.end() ? 0.0 : kMicrometre * found->expanded_uncertainty.value_or(0.0);
}

/// Whether a curvature of the straightness is told from zero.
bool is_curved(const ModelTerm& term, const ModelResult& out, const Gates& gates) {
  if (term.effect->knots() && out.straightness && !out.straightness->errors.empty()) {
    const StraightnessError& error = out.straightness->errors.front();
    return *error.value > gates.size * *error.standard_uncertainty;
  }
  const std::vector<Parameter>& parameters = term.effect->parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const FittedParameter& p = out.parameters[static_cast<std::size_t>(term.first_parameter) + i];
    if (!parameters[i].by_convention && p.value && p.standard_uncertainty &&
        std::abs(*p.value) > gates.size * *p.standard_uncertainty)
      return true;
  }
  return false;
}

void check_plausibility(const Model& model, const Solution& fit, ModelResult& out) {
  const ModelTerm* term = model.find_term(MotionError::straightness);
  const double travel = model.range.slide_max - model.range.slide_min;
  if (!term || !(travel > 0.0)) return;
  bool face = false;
  for (const Observation* observation : fit.linear.observations)
    face = face || observation->profile->setup.kind == Kind::face;
  const double found = straightness_error(model, *term, fit);
  const double part = travel / kTravel;
  const double most =
      model.gates.most_straightness * kMicrometre * (part < 1.0 ? part * part : part);
  if (!face || found - straightness_uncertainty(out) < most || !is_curved(*term, out, model.gates))
    return;
  out.implausible = "the fitted straightness is " + significant(found / kMicrometre, 2) +
                    " µm over " + significant(travel, 4) +
                    " mm; the most a slide is taken to have there is " +
                    significant(most / kMicrometre, 2) + " µm (" +
                    significant(model.gates.most_straightness, 2) + " µm over 200 mm)";
  out.notes.push_back(out.implausible + ": look for another cause before blaming the slide");
}

/// Sizes beyond the range that is given for them by more than their U: the fit does not keep
/// them inside.
void explain_range(const Model& model, const Solution& fit, ModelResult& out) {
  for (const ModelTerm& term : model.terms)
    for (std::size_t p = 0; p < term.effect->parameters().size(); ++p) {
      const Parameter& parameter = term.effect->parameters()[p];
      const Eigen::Index at = term.first_parameter + static_cast<Eigen::Index>(p);
      const double value = fit.parameters.values[at];
      const double margin =
          out.parameters[static_cast<std::size_t>(at)].expanded_uncertainty.value_or(0.0);
      const bool below = value + margin < parameter.lower;
      if (!fit.null.identifiable[at] || !(below || value - margin > parameter.upper)) continue;
      out.notes.push_back(term.name + ": " + parameter.symbol + " is " + significant(value, 3) +
                          " " + parameter.unit + ", " + (below ? "below " : "above ") +
                          shortest(below ? parameter.lower : parameter.upper) + " " +
                          parameter.unit +
                          ": a size is not held inside its bounds, but the model is then wrong");
    }
}

void explain_scaling(const Solution& fit, ModelResult& out) {
  const bool estimated =
      std::ranges::any_of(fit.noise, [](const Noise& noise) { return !noise.declared; });
  const bool correlated =
      std::ranges::any_of(fit.noise, [](const Noise& noise) { return !noise.is_white(); });
  std::string text = "uncertainties rest on the declared standard uncertainties, taken as white";
  if (estimated)
    text = std::string("uncertainties rest on the residual, ") +
           (correlated
                ? "taken as correlated noise (white, texture, long memory; restricted likelihood)"
                : "taken as white noise") +
           "; coverage factors from Student's t for 95.45 %";
  if (const double inflation = fit.uncertainty.inflation; inflation > 1.0)
    text += "; multiplied by " + significant(std::sqrt(inflation), 2) +
            ", because the slow part of the residual is larger than noise";
  out.notes.push_back(std::move(text));
}

void explain_resolution(const Solution& fit, ModelResult& out) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    if (observation.profile->resolution > 0.0 && fit.noise[i].is_estimated() &&
        fit.noise[i].standard_deviation() <
            1.001 * least_noise(*observation.profile, observation.values))
      names.push_back(observation.profile->name);
  }
  if (!names.empty())
    out.notes.push_back(joined(names) +
                        ": the residual is smaller than rounding to the resolution of the readings "
                        "makes it; their noise is taken as that rounding's (GUM F.2.2.1)");
}

void explain_other_shapes(const Model& model, const Solution& fit, ModelResult& out) {
  const std::vector<std::string> names = model.parameter_names();
  for (const OtherShape& each : fit.other_shapes)
    out.notes.push_back(names[static_cast<std::size_t>(each.parameter)] + ": " +
                        significant(each.value, 3) + " fits nearly as well (chi-square larger by " +
                        significant(each.chi_square_more, 2) + "); " +
                        (each.in_uncertainty
                             ? "every U reaches as far"
                             : "U, that of the formula's linear model, does not reach it"));
}

void explain_noise(const Solution& fit, ModelResult& out) {
  constexpr double kFew = 8.0;  // effective values: the memory is as long as the trace
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    const std::string profile = "profile '" + observation.profile->name + "'";
    const Noise& noise = fit.noise[i];
    if (!noise.declared && is_rounding(fit.linear.residuals[i], observation.values) &&
        noise.standard_deviation() > observation.profile->resolution)
      out.notes.push_back(profile +
                          ": the model passes through its values, so U holds the rounding of "
                          "numbers alone; no instrument is so exact");
    if (!noise.is_white() && noise.effective_values() < kFew)
      out.notes.push_back(profile +
                          ": the residual is correlated over the whole trace; a slow error that "
                          "the model lacks would look the same");
    if (noise.unlike_sisters)
      out.notes.push_back(profile + " differs: its noise is " +
                          significant(*noise.unlike_sisters, 2) +
                          " times that of the profiles beside it");
  }
}

/// The value of an observation that lies farthest from the model, and how many standard deviations
/// of the others that is. None where noise makes one as far with at least probability `p_value` (of
/// a largest externally studentised residual: Grubbs 1969; Rosner 1983).
struct FarValue {
  Eigen::Index at = 0;
  double deviations = 0.0;
};
std::optional<FarValue> far_value(const Observation& observation, const Eigen::VectorXd& residual,
                                  const Noise& noise, double p_value) {
  Eigen::MatrixXd white = residual;
  noise.whiten(white);
  for (const Eigen::Index i : left_out_values(observation)) white(i, 0) = 0.0;
  const double freedom = static_cast<double>(residual.size() - observation.left_out()) - 2.0;
  FarValue out;
  const double largest = white.col(0).cwiseAbs().maxCoeff(&out.at);
  const double of_others = (white.squaredNorm() - largest * largest) / freedom;
  if (!(freedom > 2.0) || !(of_others > 0.0)) return std::nullopt;
  out.deviations = largest / std::sqrt(of_others);
  const double tail = 2.0 * (freedom + 2.0) * student_tail(freedom, out.deviations);
  if (tail >= p_value) return std::nullopt;
  return out;
}

void explain_far_values(const Model& model, const Solution& fit, ModelResult& out) {
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    const Profile& profile = *observation.profile;
    const Eigen::VectorXd& residual = fit.linear.residuals[i];
    if (profile.loss != Loss::none || is_rounding(residual, observation.values)) continue;
    const auto far = far_value(observation, residual, fit.noise[i], model.gates.lack_of_fit_p);
    if (!far) continue;
    const bool height = profile.setup.quantity == Quantity::height;
    out.notes.push_back(
        "profile '" + profile.name + "': the value at " +
        significant(
            observation.low_band.positions(profile.positions)[static_cast<std::size_t>(far->at)],
            6) +
        " mm is " +
        significant(std::abs(residual[far->at]) / low_band_scale(observation) /
                        (height ? kMicrometre : kMicroradian),
                    3) +
        (height ? " µm" : " µrad") + " from the model, " + significant(far->deviations, 2) +
        " standard deviations of the others: was it read wrongly? leave_out takes it out");
  }
}

/// What is ahead of its cause, and errors in variables: what U holds of the error of the log.
void explain_measured_cause(const Parameter& parameter, const FittedParameter& found,
                            double error_of_log, ModelResult& out) {
  constexpr double kMatters = 0.1;  // of the variance
  if (parameter.symbol == "lag" && *found.value + *found.expanded_uncertainty < 0.0)
    out.notes.push_back(found.name +
                        " is below 0: no effect is ahead of its cause, so the clock of the log or "
                        "the start of the cuts is wrong by about as much");
  const double share = std::pow(error_of_log / *found.standard_uncertainty, 2);
  if (share > kMatters)
    out.notes.push_back(found.name + ": " + significant(100.0 * std::min(share, 1.0), 2) +
                        " % of the variance in its U comes from the noise and the spacing of the "
                        "log");
}

void explain_measured_causes(const Model& model, const Solution& fit, ModelResult& out) {
  const Eigen::MatrixXd& to_causes = fit.uncertainty.departures.to_causes;
  for (const ModelTerm& term : model.terms) {
    if (!term.effect->description().measured) continue;
    Eigen::Index row = term.first_parameter;
    for (const Parameter& parameter : term.effect->parameters()) {
      const double error =
          to_causes.cols() > 0 ? (fit.parameters.jacobian.row(row) * to_causes).norm() : 0.0;
      ++row;
      const FittedParameter* found = out.find(term.name + "." + parameter.name);
      if (found && found->value && found->expanded_uncertainty)
        explain_measured_cause(parameter, *found, error, out);
    }
  }
}

void explain_laws(const Model& model, const Solution& fit, ModelResult& out) {
  if (fit.uncertainty.departures.to_laws.cols() == 0) return;
  out.notes.push_back(
      "the drift of the instrument's zero is taken as a line in time; every U allows for a bend "
      "of it, " +
      significant(100.0 * model.gates.drift_bend, 2) +
      " % of what it makes in all: one run there and one back do not show a bend, two of each do");
}

void explain_priors(const Model& model, const Solution& fit, ModelResult& out) {
  if (auto conflict = conflict_of_priors(model, fit)) out.notes.push_back(*std::move(conflict));
}

void explain_left_out(const Model& model, ModelResult& out) {
  std::vector<std::string> parts;
  for (const Observation& observation : model.observations)
    if (observation.left_out() > 0)
      parts.push_back("'" + observation.profile->name + "' " +
                      std::to_string(observation.left_out()) + " of " +
                      std::to_string(observation.values.size()));
  if (!parts.empty())
    out.notes.push_back(
        "low-band values are left out that lie beyond an end of the trace, in a gap, within a "
        "groove of the spindle axis, or where a tool's nose cannot follow: " +
        joined(parts));
}

}  // namespace

void add_checks(const Model& model, const Solution& fit, ModelResult& out) {
  if (const std::optional<double> gap = neglected_height(model, fit))
    out.neglected_um = *gap / kMicrometre;
  explain_scaling(fit, out);
  explain_resolution(fit, out);
  explain_form(model, fit, out);
  explain_other_shapes(model, fit, out);
  explain_noise(fit, out);
  explain_far_values(model, fit, out);
  explain_measured_causes(model, fit, out);
  explain_laws(model, fit, out);
  check_plausibility(model, fit, out);
  explain_range(model, fit, out);
  for (const Observation& observation : model.observations) {
    if (observation.low_band.resampled())
      out.notes.push_back("profile '" + observation.profile->name +
                          "': positions are not uniform; brought to a uniform grid for the wavelet "
                          "by linear interpolation, the model's columns likewise");
  }
  explain_priors(model, fit, out);
  explain_left_out(model, out);
}

}  // namespace slideway
