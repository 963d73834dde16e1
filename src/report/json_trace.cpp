#include "json_parts.hpp"

namespace slideway {
namespace {

Json tried(const TriedEffect& effect) {
  return {{"effect", effect.effect},
          {"delta_bic", effect.delta_bic},
          {"p_value", effect.p_value},
          {"rms_um", or_null(effect.rms_um)},
          {"parameters", array_of(effect.parameters, parameter_json)},
          {"refused", effect.refused.empty() ? Json(nullptr) : Json(effect.refused)}};
}

Json round(const TraceRound& round) {
  return {{"accepted", round.accepted},
          {"ambiguous_with", round.ambiguous_with},
          {"before_rms_um", or_null(round.before_rms_um)},
          {"after_rms_um", or_null(round.after_rms_um)},
          {"before_rms_urad", or_null(round.before_rms_urad)},
          {"after_rms_urad", or_null(round.after_rms_urad)},
          {"before_holdout_rms_um", or_null(round.before_holdout_rms_um)},
          {"after_holdout_rms_um", or_null(round.after_holdout_rms_um)},
          {"delta_bic", round.delta_bic},
          {"p_value", round.p_value},
          {"parameters", array_of(round.parameters, parameter_json)},
          {"candidates", array_of(round.candidates, tried)}};
}

Json unnamed(const Unnamed& left) {
  Json evidence = Json::object();
  for (const auto& [clock, value] : left.log_evidence) evidence[clock] = value;
  return {{"rms_" + left.unit, left.rms},
          {"pv_" + left.unit, left.pv},
          {"p_value", left.p_value},
          {"profile", left.profile},
          {"from_mm", left.from_mm},
          {"to_mm", left.to_mm},
          {"clock", left.clock},
          {"log_evidence", evidence},
          {"correlation_length", left.correlation_length},
          {"correlation_unit", left.correlation_unit},
          {"dominant_period_mm", or_null(left.dominant_period_mm)},
          {"odd_share", or_null(left.odd_share)}};
}

Json limit(const DetectionLimit& limit) {
  Json by_shape = Json::array();
  for (const auto& [shape, value] : limit.by_shape)
    by_shape.push_back({{"shape", shape}, {"value", value}});
  return {{"effect", limit.effect}, {"parameter", limit.parameter},
          {"unit", limit.unit},     {"value", limit.value},
          {"at", limit.at},         {"by_shape", by_shape}};
}

}  // namespace

Json trace_json(const TraceResult& trace) {
  const auto needs = [](const auto& pair) {
    return Json{{"effect", pair.first}, {"needs", pair.second}};
  };
  const auto same = [](const auto& pair) {
    return Json{{"effect", pair.first}, {"same_as", pair.second}};
  };
  return {{"verdict", trace.verdict},
          {"rounds", array_of(trace.rounds, round)},
          {"unnamed", trace.unnamed ? unnamed(*trace.unnamed) : Json(nullptr)},
          {"advice", trace.advice},
          {"not_testable", array_of(trace.not_testable, needs)},
          {"not_separable", array_of(trace.not_separable, same)},
          {"refused", array_of(trace.refused, tried)},
          {"detection_limits", array_of(trace.detection_limits, limit)},
          {"lack_of_fit_p", trace.lack_of_fit_p},
          {"notes", trace.notes}};
}

}  // namespace slideway
