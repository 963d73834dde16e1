#include "slideway/trace/unseen.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "dictionary.hpp"
#include "readings.hpp"
#include "response.hpp"
#include "search.hpp"
#include "slideway/base/error.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/solve.hpp"
#include "slideway/identify/straightness.hpp"
#include "whitened.hpp"

namespace slideway {
namespace {

/// Whether a parameter of an error of the carriages is among names joined by commas.
bool has_parameter_of(MotionError error, const std::string& names) {
  for (std::size_t at = 0; at < names.size(); at = names.find_first_of(' ', at))
    if (at = names.find_first_not_of(' ', at); motion_error_of(names.substr(at)) == error)
      return true;
  return false;
}

/// Null where the machine has several carriages it may belong to.
std::shared_ptr<const Effect> made_without_options(const std::string& effect, const Model& model) {
  try {
    return make_effect(effect, {}, model.machine, model.range);
  } catch (const UsageError&) {
    return nullptr;
  }
}

/// Whether one standard uncertainty of an effect that is not in the model would move the form of
/// the slide by more than that is uncertain.
bool is_hidden(const FittedModel& fitted, const Whitened& data, const std::string& effect) {
  const auto& [model, fit] = fitted;
  const ModelTerm* const form = model.find_term(MotionError::straightness);
  if (!form || has_effect(model, effect)) return false;
  const std::shared_ptr<const Effect> made = made_without_options(effect, model);
  if (!made) return false;
  const ModelTerm term{effect, made, {}};
  for (const Observation* each : fitted_observations(model))
    if (const Setup& setup = each->profile->setup;
        term.effect->applies_to(setup) && !term.effect->lacking(setup).empty())
      return false;
  const Eigen::MatrixXd column = stacked_columns(model, term, {}, fit.linear.prior_rows.rows());
  if (project(data, column).rank == 0) return false;  // same_columns_as()
  const double shown = data.outside(column).norm();
  const Eigen::VectorXd moved = response(fit, column);
  const Eigen::MatrixXd deviations =
      deviations_from_ends(model, *form, fit, measured_travel(model, form));
  for (Eigen::Index i = 0; i < deviations.rows(); ++i) {
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(moved.size());
    row.segment(form->first_amplitude, deviations.cols()) = deviations.row(i);
    if (std::abs(row.dot(moved)) > shown * fit.uncertainty.of(row).standard_uncertainty)
      return true;
  }
  return false;
}

/// A form of the workpiece alone, without shapes: readings of the slide tell it from the slide's.
bool is_of_workpiece(const Effect& effect) {
  Setup face, slide;
  slide.kind = Kind::slide;
  return !effect.is_carriage() && !effect.description().of_instrument && effect.shapes().empty() &&
         effect.amplitudes() == 1 && effect.applies_to(face) && !effect.applies_to(slide);
}

/// What the form of the slide hides: a squareness that nobody declared, which every machine has,
/// and forms of the workpiece that readings of the slide tell from it, if they are precise enough.
std::vector<std::string> hidden_effects(const FittedModel& fitted, bool beside_slide) {
  const Whitened data(fitted.fit.linear, fitted.fit.noise);
  std::vector<std::string> out;
  for (const std::string& name : effect_names())
    if ((motion_error_of(name) == MotionError::squareness ||
         (beside_slide && is_of_workpiece(specimen(name)))) &&
        is_hidden(fitted, data, name))
      out.push_back(name);
  return out;
}

}  // namespace

const DetectionLimit* worst_unseen(const TraceResult& trace, MovedUnseen number) {
  const DetectionLimit* worst = nullptr;
  for (const DetectionLimit& each : trace.detection_limits)
    if (each.*number && (!worst || *(each.*number) > *(worst->*number))) worst = &each;
  return worst;
}

std::vector<std::string> same_columns_as(MotionError error, const TraceResult& trace) {
  std::vector<std::string> names;
  for (const NotSeparable& each : trace.not_separable)
    if (has_parameter_of(error, each.same_as) &&
        motion_error_of(each.effect) != MotionError::vertical_straightness &&
        motion_error_of(each.effect) != error)
      names.push_back(each.effect);
  return names;
}

void add_conditions(const FittedModel& fitted, const TraceResult& trace, Result& result) {
  if (!result.final) return;
  const auto observations = fitted_observations(fitted.model);
  const bool faces = !std::ranges::all_of(observations, reads_slide),
             slides = std::ranges::any_of(observations, reads_slide);
  std::vector<std::string> squareness, straightness;
  if (faces) {
    squareness = same_columns_as(MotionError::squareness, trace);
    straightness = same_columns_as(MotionError::straightness, trace);
    std::ranges::move(hidden_effects(fitted, slides), std::back_inserter(straightness));
  }
  for (const std::string& error : errors_of_readings(fitted.model)) {
    straightness.push_back(error);
    const auto has_it = [&](const TraceRound& round) {
      return std::ranges::count(round.ambiguous_with, error) > 0;
    };
    if (std::ranges::any_of(trace.rounds, has_it)) squareness.push_back(error);
  }
  for (FittedParameter& parameter : result.final->parameters)
    if (motion_error_of(parameter.name) == MotionError::squareness && parameter.value)
      parameter.if_no = squareness;
  if (result.final->straightness && !result.final->straightness->errors.empty())
    result.final->straightness->if_no = straightness;
  for (Conformity& each : result.conformity)
    if (each.what != kFlatness) each.if_no = each.limit_um_per_m ? squareness : straightness;
}

bool may_be_moved_unseen(const ModelResult& model, const TraceResult& trace) {
  const FittedParameter* const squareness = model.squareness();
  if (!squareness || !squareness->value || !squareness->expanded_uncertainty) return false;
  const DetectionLimit* const worst = worst_unseen(trace, &DetectionLimit::squareness_rad);
  return worst != nullptr && (*worst->squareness_rad > *squareness->expanded_uncertainty ||
                              !same_columns_as(MotionError::squareness, trace).empty());
}

bool may_be_bent_unseen(const ModelResult& model, const TraceResult& trace) {
  const auto& form = model.straightness;
  if (!form || !form->expanded_uncertainty_um) return false;
  const DetectionLimit* const worst = worst_unseen(trace, &DetectionLimit::straightness_um);
  return worst != nullptr && *worst->straightness_um > *form->expanded_uncertainty_um;
}

bool wants_another_cut(const ModelResult& model, const TraceResult& trace) {
  return !open_directions(model).empty() || may_be_moved_unseen(model, trace);
}

}  // namespace slideway
