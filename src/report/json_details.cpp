#include "json_parts.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr int kDigits = 5;          // of what is drawn
constexpr int kPositionDigits = 7;  // neighbours of a long trace stay apart

Json drawn(const std::vector<double>& values, int digits = kDigits) {
  return array_of(values, [digits](double v) { return *parse_double(significant(v, digits)); });
}

std::string axis_name(Axis axis) { return axis == Axis::x ? "x" : axis == Axis::y ? "y" : "z"; }

Json effect(const EffectInModel& effect) {
  const Description& what = effect.description;
  return {{"name", what.name},
          {"standard_name", what.standard_name},
          {"formula", what.formula},
          {"source", what.source},
          {"cause", what.cause},
          {"clock", symbol(what.variable)},
          {"confounded_with", what.confounded_with},
          {"separated_by", what.separated_by},
          {"added", effect.added}};
}

Json options(const Problem& problem) {
  const auto body = [](const Body& b) {
    return Json{{"name", b.name}, {"lower", b.lower}, {"axis", axis_name(b.axis)}};
  };
  Json priors = Json::array();
  for (const DeclaredEffect& declared : problem.effects)
    for (const Prior& prior : declared.priors)
      priors.push_back({{"parameter", declared.name + "." + prior.parameter},
                        {"value", prior.value},
                        {"standard_uncertainty", prior.standard_uncertainty}});
  Json out = {{"lever", problem.lever == Lever::paper ? "paper" : "split"},
              {"bodies", array_of(problem.bodies, body)},
              {"priors", priors},
              {"runout", nullptr},
              {"candidates", problem.trace.candidates},
              {"max_effects", problem.trace.max_effects},
              {"significance", problem.trace.gates.significance}};
  if (problem.runout)
    out["runout"] = {{"r_um", problem.runout->r_um},
                     {"p_um", problem.runout->p_um},
                     {"diameter_mm", problem.runout->diameter_mm},
                     {"standard_uncertainty_um", problem.runout->standard_uncertainty_um}};
  return out;
}

Json straightness(const IdentifiedStraightness& found) {
  const auto error = [](const IdentifiedStraightness::Error& e) {
    return Json{{"line", e.line},
                {"error_um", e.error_um},
                {"standard_uncertainty_um", e.standard_uncertainty_um},
                {"expanded_uncertainty_um", e.expanded_uncertainty_um},
                {"coverage_factor", e.coverage_factor},
                {"highest_um", e.highest_um},
                {"highest_at_mm", e.highest_at_mm},
                {"lowest_um", e.lowest_um},
                {"lowest_at_mm", e.lowest_at_mm}};
  };
  return {{"reason", found.reason}, {"errors", array_of(found.errors, error)}};
}

Json budget(const Budget& budget) {
  const auto line = [](const BudgetLine& each) {
    return Json{{"source", each.source},
                {"type", std::string(1, each.type)},
                {"standard_uncertainty", each.standard_uncertainty}};
  };
  return {{"parameter", budget.parameter},
          {"unit", budget.unit},
          {"lines", array_of(budget.lines, line)}};
}

Json setup(const Setup& setup) {
  const auto direction = [](CutDirection d) {
    return d == CutDirection::inward ? "inward" : "outward";
  };
  return {{"center_mm", setup.center_mm},
          {"spindle_position_mm", setup.spindle_position_mm},
          {"z_mm", setup.z_mm},
          {"overhang_mm", setup.overhang_mm},
          {"base_mm", or_null(setup.base_mm)},
          {"feed_mm_per_min", or_null(setup.feed_mm_per_min)},
          {"spindle_rpm", or_null(setup.spindle_rpm)},
          {"cut_direction",
           setup.cut_direction ? Json(direction(*setup.cut_direction)) : Json(nullptr)},
          {"cut_radius_mm", or_null(setup.cut_radius_mm)},
          {"start_s", setup.start_s},
          {"traverse_mm_per_s", or_null(setup.traverse_mm_per_s)}};
}

Json spectrum(const Spectrum& spectrum) {
  return {{"cycles_per_mm", drawn(spectrum.cycles_per_sample)},
          {"amplitude", drawn(spectrum.amplitude)}};
}

Json band(const Envelope& band) { return {{"low", drawn(band.low)}, {"high", drawn(band.high)}}; }

Json curve(const ProfileCurves& c) {
  const auto numbers = [](const std::vector<double>& row) { return drawn(row); };
  return {{"profile", c.profile},
          {"role", c.role},
          {"unit", c.unit},
          {"first_mm", c.setup.first_mm},
          {"last_mm", c.setup.last_mm},
          {"position_mm", drawn(c.position_mm, kPositionDigits)},
          {"raw", drawn(c.raw)},
          {"low_band", drawn(c.low_band)},
          {"model_before", drawn(c.model_before)},
          {"residual_before", drawn(c.residual_before)},
          {"model_after", drawn(c.model_after)},
          {"residual_after", drawn(c.residual_after)},
          {"contribution_position_mm", drawn(c.contribution_position_mm, kPositionDigits)},
          {"effects", c.effects},
          {"contributions", array_of(c.contributions, numbers)},
          {"correlation", array_of(c.correlation, numbers)},
          {"lag_mm", c.lag_mm},
          {"white_limit", c.white_limit},
          {"autocorrelation_before", drawn(c.autocorrelation_before)},
          {"autocorrelation_after", drawn(c.autocorrelation_after)},
          {"spectrum_before", spectrum(c.spectrum_before)},
          {"spectrum_after", spectrum(c.spectrum_after)},
          {"approximations", array_of(c.approximations, band)},
          {"details", array_of(c.details, band)}};
}

}  // namespace

void add_details(const Details& details, Json& report) {
  Json setups = Json::array(), what_if = Json::array();
  for (const ProfileCurves& c : details.profiles) {
    Json own = {{"profile", c.profile}};
    own.update(setup(c.setup));
    setups.push_back(std::move(own));
    for (const PredictedFlatness& each : c.flatness)
      what_if.push_back({{"profile", c.profile},
                         {"corrected", each.corrected},
                         {"pv_" + c.unit, each.pv},
                         {"rms_" + c.unit, each.rms}});
  }
  report["model"] = array_of(details.effects, effect);
  report["setups"] = setups;
  report["options"] = options(details.problem);
  report["straightness"] = details.straightness ? straightness(*details.straightness) : Json();
  report["uncertainty_budget"] = array_of(details.budget, budget);
  report["what_if"] = what_if;
}

Json curves_json(const Details& details) {
  const IdentifiedStraightness none;
  const IdentifiedStraightness& found = details.straightness ? *details.straightness : none;
  return {{"straightness",
           {{"position_mm", drawn(found.position_mm, kPositionDigits)},
            {"deviation_um", drawn(found.deviation_um)},
            {"expanded_uncertainty_um", drawn(found.expanded_uncertainty_um)}}},
          {"profiles", array_of(details.profiles, curve)}};
}

}  // namespace slideway
