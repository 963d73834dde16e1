#include "document_node.hpp"

namespace slideway {
namespace {

TriedEffect tried(const Node& node) {
  return {node["effect"].text(),
          node["delta_bic"].number(),
          node["p_value"].number(),
          node["rms_um"].number_or_null(),
          node["parameters"].list(fitted_parameter),
          node["refused"].text_or_null().value_or("")};
}

TraceRound round(const Node& node) {
  TraceRound out;
  out.accepted = node["accepted"].text();
  out.ambiguous_with = node["ambiguous_with"].texts();
  out.before_rms_um = node["before_rms_um"].number_or_null();
  out.after_rms_um = node["after_rms_um"].number_or_null();
  out.before_rms_urad = node["before_rms_urad"].number_or_null();
  out.after_rms_urad = node["after_rms_urad"].number_or_null();
  out.before_holdout_rms_um = node["before_holdout_rms_um"].number_or_null();
  out.after_holdout_rms_um = node["after_holdout_rms_um"].number_or_null();
  out.delta_bic = node["delta_bic"].number();
  out.p_value = node["p_value"].number();
  out.parameters = node["parameters"].list(fitted_parameter);
  out.candidates = node["candidates"].list(tried);
  return out;
}

Unnamed unnamed(const Node& node) {
  Unnamed out;
  out.unit = node["rms_um"].is_null() ? "urad" : "um";
  out.rms = node["rms_" + out.unit].number();
  out.pv = node["pv_" + out.unit].number();
  out.p_value = node["p_value"].number();
  out.profile = node["profile"].text();
  out.from_mm = node["from_mm"].number();
  out.to_mm = node["to_mm"].number();
  out.clock = node["clock"].text();
  out.log_evidence = node["log_evidence"].named_numbers();
  out.correlation_length = node["correlation_length"].number();
  out.correlation_unit = node["correlation_unit"].text();
  out.dominant_period_mm = node["dominant_period_mm"].number_or_null();
  out.odd_share = node["odd_share"].number_or_null();
  return out;
}

DetectionLimit limit(const Node& node) {
  const auto at_shape = [](const Node& each) {
    return std::pair(each["shape"].number(), each["value"].number());
  };
  return {node["effect"].text(),  node["parameter"].text(), node["unit"].text(),
          node["value"].number(), node["at"].text(),        node["by_shape"].list(at_shape)};
}

std::vector<std::pair<std::string, std::string>> pairs(const Node& node,
                                                       const std::string& second) {
  return node.list(
      [&](const Node& each) { return std::pair(each["effect"].text(), each[second].text()); });
}

}  // namespace

TraceResult trace_result(const Node& report) {
  const Node node = report["trace"], before = report["before"], after = report["after"];
  TraceResult out;
  out.verdict = node["verdict"].text();
  out.rounds = node["rounds"].list(round);
  if (node.has("unnamed")) out.unnamed = unnamed(node["unnamed"]);
  out.advice = node["advice"].texts();
  out.not_testable = pairs(node["not_testable"], "needs");
  out.not_separable = pairs(node["not_separable"], "same_as");
  out.refused = node["refused"].list(tried);
  out.detection_limits = node["detection_limits"].list(limit);
  out.lack_of_fit_p = node["lack_of_fit_p"].number();
  out.notes = node["notes"].texts();
  out.before_rms_um = before["rms_um"].number_or_null();
  out.before_rms_urad = before["rms_urad"].number_or_null();
  out.before = before["parameters"].list(fitted_parameter);
  out.after_rms_um = after["rms_um"].number_or_null();
  out.after_rms_urad = after["rms_urad"].number_or_null();
  out.after = after["parameters"].list(fitted_parameter);
  return out;
}

}  // namespace slideway
