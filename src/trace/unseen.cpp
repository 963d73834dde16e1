#include "slideway/trace/unseen.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <set>

#include "dictionary.hpp"
#include "response.hpp"
#include "search.hpp"
#include "slideway/base/error.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/identify.hpp"
#include "slideway/identify/solve.hpp"
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

bool reads_slide(const Observation* observation) {
  return observation->profile->setup.kind == Kind::slide;
}

bool reads_face(const Observation* observation) { return !reads_slide(observation); }

bool has(const Model& model, const std::string& effect) {
  return std::ranges::any_of(model.terms, [&](const ModelTerm& term) {
    return term.effect->description().name == effect;
  });
}

/// Errors of the readings of a slide that look like its form. At an even pace a drift of the zero
/// makes slopes so: read there and back, or reversed, only one of the two changes its sign. Of
/// heights it is the form of what they are measured against, which is asked only where faces do not
/// show the same: there the difference is laid to the workpiece.
std::vector<std::string> errors_of_readings(const Model& model, bool beside_faces) {
  std::set<Quantity> quantities;
  std::set<bool> reversed, falls;  // of a drift, over the slide
  for (const Observation* each : fitted_observations(model)) {
    if (!reads_slide(each)) continue;
    const Setup& setup = each->profile->setup;
    quantities.insert(setup.quantity);
    reversed.insert(setup.reversed);
    falls.insert((travel_direction(setup) == CutDirection::inward) != setup.reversed);
  }
  std::vector<std::string> out;
  for (const std::string& name : effect_names()) {
    const Description& effect = specimen(name).description();
    const bool is_drift = quantities == std::set{Quantity::slope} && falls.size() == 1 &&
                          is_drift_of_instrument(effect),
               is_datum = beside_faces && quantities == std::set{Quantity::height} &&
                          reversed.size() == 1 && effect.of_instrument &&
                          effect.variable == IndependentVariable::slide;
    if ((is_drift || is_datum) && !has(model, name)) out.push_back(name);
  }
  return out;
}

/// Of the form of a slide at places between the ends of the travel, from the line through them: a
/// column each amplitude.
Eigen::MatrixXd deviations_from_ends(const Model& model, const ModelTerm& form,
                                     const Solution& fit) {
  constexpr Eigen::Index kAlong = 21;
  const SlideRange travel = measured_travel(model, &form);
  const Eigen::VectorXd share = Eigen::VectorXd::LinSpaced(kAlong, 0.0, 1.0),
                        x = travel.least + (travel.greatest - travel.least) * share.array();
  Eigen::MatrixXd out = along_slide(*form.effect, model.machine, x, Quantity::height,
                                    shapes_of(form, fit.estimate.shapes));
  const Eigen::RowVectorXd first = out.row(0), last = out.row(kAlong - 1);
  out -= (1.0 - share.array()).matrix() * first + share * last;
  return out.middleRows(1, kAlong - 2);
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
  if (!form || has(model, effect)) return false;
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
  const Eigen::MatrixXd deviations = deviations_from_ends(model, *form, fit);
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

void add_conditions(const FittedModel& fitted, const TraceResult& trace, Result& result) {
  if (!result.final) return;
  const auto observations = fitted_observations(fitted.model);
  const bool faces = std::ranges::any_of(observations, reads_face),
             slides = std::ranges::any_of(observations, reads_slide);
  std::vector<std::string> squareness, straightness;
  if (faces) {
    squareness = same_columns_as(MotionError::squareness, trace);
    straightness = same_columns_as(MotionError::straightness, trace);
    std::ranges::move(hidden_effects(fitted, slides), std::back_inserter(straightness));
  }
  if (slides)
    std::ranges::move(errors_of_readings(fitted.model, faces), std::back_inserter(straightness));
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
