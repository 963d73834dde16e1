#include "slideway/trace/unseen.hpp"

#include <algorithm>
#include <functional>

#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {
namespace {

/// Whether a parameter of an error of the carriages is among names joined by commas.
bool has_parameter_of(MotionError error, const std::string& names) {
  for (std::size_t at = 0; at < names.size(); at = names.find_first_of(' ', at))
    if (at = names.find_first_not_of(' ', at); motion_error_of(names.substr(at)) == error)
      return true;
  return false;
}

bool reads_slide(const Observation* observation) {
  return observation->profile->setup.kind == Kind::slide;
}

/// Whether a zero that drifts at an even pace makes slopes as the form of the slide does: read
/// there and back, or reversed, only one of the two changes its sign.
bool may_hold_drift(const Model& model) {
  if (std::ranges::any_of(model.terms, [](const ModelTerm& term) {
        return is_drift_of_instrument(term.effect->description());
      }))
    return false;
  bool rises = false, falls = false;
  for (const Observation* each : fitted_observations(model)) {
    const Setup& setup = each->profile->setup;
    if (setup.quantity != Quantity::slope) return false;
    const bool back = travel_direction(setup) == CutDirection::inward;
    (back == setup.reversed ? rises : falls) = true;
  }
  return rises != falls;
}

}  // namespace

const DetectionLimit* worst_unseen(const TraceResult& trace) {
  const DetectionLimit* worst = nullptr;
  for (const DetectionLimit& each : trace.detection_limits)
    if (each.squareness_rad && (!worst || *each.squareness_rad > *worst->squareness_rad))
      worst = &each;
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

void add_conditions(const Model& model, const TraceResult& trace, Result& result) {
  if (!result.final) return;
  std::vector<std::string> squareness, straightness;
  if (std::ranges::any_of(fitted_observations(model), std::not_fn(reads_slide))) {
    squareness = same_columns_as(MotionError::squareness, trace);
    straightness = same_columns_as(MotionError::straightness, trace);
  } else if (may_hold_drift(model)) {
    for (const std::string& name : effect_names())
      if (is_drift_of_instrument(specimen(name).description())) straightness.push_back(name);
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
  const DetectionLimit* const worst = worst_unseen(trace);
  return worst != nullptr && (*worst->squareness_rad > *squareness->expanded_uncertainty ||
                              !same_columns_as(MotionError::squareness, trace).empty());
}

bool wants_another_cut(const ModelResult& model, const TraceResult& trace) {
  return !open_directions(model).empty() || may_be_moved_unseen(model, trace);
}

}  // namespace slideway
