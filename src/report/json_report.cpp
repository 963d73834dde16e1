#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "json_parts.hpp"
#include "slideway/report/report.hpp"

namespace slideway {

Json parameter_json(const FittedParameter& p) {
  const auto determined = [&p](const std::optional<double>& value) {
    return p.identifiable ? or_null(value) : Json(nullptr);
  };
  return {{"name", p.name},
          {"symbol", p.symbol},
          {"standard_name", p.standard_name},
          {"value", determined(p.value)},
          {"unit", p.unit},
          {"standard_uncertainty", determined(p.standard_uncertainty)},
          {"expanded_uncertainty", determined(p.expanded_uncertainty)},
          {"coverage_factor", p.coverage_factor},
          {"degrees_of_freedom", or_null(p.degrees_of_freedom)},
          {"identifiable", p.identifiable},
          {"at_bound", p.at_bound}};
}

namespace {

Json combination(const Combination& terms) {
  Json object = Json::object();
  for (const auto& [name, coefficient] : terms) object[name] = coefficient;
  return object;
}

Json outlier(const OutlierSummary& each) {
  return {{"row", each.row},
          {"value", each.value},
          {"expected", each.expected},
          {"unit", each.unit},
          {"kind", each.kind}};
}

Json input(const InputSummary& in) {
  Json json = {{"name", in.name},
               {"file", in.file},
               {"format", in.format},
               {"sha256", in.sha256},
               {"kind", in.kind},
               {"quantity", in.quantity},
               {"role", in.role},
               {"samples", in.samples},
               {"missing", in.missing},
               {"left_out", in.left_out},
               {"outlier_count", in.outlier_count},
               {"outliers", array_of(in.outliers, outlier)},
               {"position_min_mm", in.position_min_mm},
               {"position_max_mm", in.position_max_mm},
               {"rms_um", or_null(in.rms_um)},
               {"pv_um", or_null(in.pv_um)},
               {"rms_urad", or_null(in.rms_urad)},
               {"pv_urad", or_null(in.pv_urad)}};
  json["notes"] = in.notes;
  return json;
}

Json misclosure(const MisclosureSummary& each) {
  return {{"profile", each.profile},
          {"x_mm", each.x_mm},
          {"y_mm", each.y_mm},
          {"difference_um", or_null(each.difference_um)},
          {"closure_um", or_null(each.closure_um)},
          {"standard_uncertainty_um", or_null(each.standard_uncertainty_um)}};
}

Json repeat(const RepeatSummary& each) {
  return {{"a", each.a},
          {"b", each.b},
          {"stations", each.stations},
          {"x_mm", each.x_mm},
          {"y_mm", each.y_mm},
          {"difference_um", each.difference_um},
          {"standard_uncertainty_um", each.standard_uncertainty_um},
          {"limit", each.limit},
          {"verdict", each.verdict}};
}

Json closure(const ClosureSummary& what) {
  return {{"verdict", what.verdict},
          {"lines", what.lines},
          {"places", what.places},
          {"redundancy", what.redundancy},
          {"false_alarm", what.false_alarm},
          {"limit", or_null(what.limit)},
          {"tied", what.tied},
          {"readings", array_of(what.readings, misclosure)},
          {"repeats", array_of(what.repeats, repeat)},
          {"suspects", what.suspects},
          {"notes", what.notes}};
}

Json head(const Result& result, std::string_view schema) {
  return {{"schema", schema},
          {"version", result.version},
          {"title", result.title},
          {"inputs", array_of(result.inputs, input)},
          {"closure", result.closure ? closure(*result.closure) : Json(nullptr)}};
}

Json travel(const TravelSummary& t) {
  return {{"lever", t.lever},
          {"slide_min_mm", t.slide_min_mm},
          {"slide_max_mm", t.slide_max_mm},
          {"spindle_position_mm", or_null(t.spindle_position_mm)},
          {"overhang_mm", or_null(t.overhang_mm)}};
}

Json ranking_entry(const Ranking& entry) {
  const Json running = {{"samples", entry.running.samples},
                        {"raw", entry.running.raw},
                        {"low_band", entry.running.low_band}};
  return {{"effect", entry.effect},
          {"profile", entry.profile},
          {"raw", entry.raw},
          {"low_band", entry.low_band},
          {"lag_mm", entry.lag_mm},
          {"lag_coefficient", entry.lag_coefficient},
          {"effective_observations", entry.effective_observations},
          {"p_value", entry.p_value},
          {"running", running}};
}

Json candidate_correlation(const CandidateCorrelation& pair) {
  return {
      {"a", pair.a}, {"b", pair.b}, {"profile", pair.profile}, {"coefficient", pair.coefficient}};
}

Json identifiability(const Identifiability& what) {
  const auto direction = [](const UndeterminedDirection& d) {
    return Json{{"combination", combination(d.combination)}, {"advice", d.advice}};
  };
  const auto determined = [](const DeterminedCombination& d) {
    return Json{{"combination", combination(d.combination)},
                {"value", d.value},
                {"unit", d.unit},
                {"standard_uncertainty", d.standard_uncertainty},
                {"expanded_uncertainty", d.expanded_uncertainty}};
  };
  return {{"parameters", what.parameters},
          {"rank", what.rank},
          {"condition", what.condition},
          {"unidentifiable", array_of(what.unidentifiable, direction)},
          {"determined", array_of(what.determined, determined)}};
}

Json noise(const NoiseSummary& n) {
  return {{"profile", n.profile},
          {"scaling", n.scaling},
          {"order", n.order},
          {"standard_deviation_um", or_null(n.standard_deviation_um)},
          {"standard_deviation_urad", or_null(n.standard_deviation_urad)},
          {"correlation_mm", n.correlation_mm},
          {"effective_observations", n.effective_observations},
          {"ljung_box_p", n.ljung_box_p}};
}

Json contribution(const Contribution& c, const Result& result) {
  const auto of_profile = [&c](const InputSummary& in) { return in.name == c.profile; };
  const auto in = std::find_if(result.inputs.begin(), result.inputs.end(), of_profile);
  const bool slope = in != result.inputs.end() && in->quantity == "slope";
  return {{"effect", c.effect},
          {"profile", c.profile},
          {slope ? "rms_urad" : "rms_um", c.rms_um},
          {"share", c.share}};
}

Json residual(const ResidualSummary& r) {
  const std::string unit = r.unit == "urad" ? "urad" : "um";
  return {
      {"profile", r.profile}, {"role", r.role}, {"rms_" + unit, r.rms_um}, {"pv_" + unit, r.pv_um}};
}

Json fit_json(const FitResult& fit, const Result& result) {
  const auto share = [&result](const Contribution& c) { return contribution(c, result); };
  const auto correlation = [](const auto& entry) {
    return Json::array({std::get<0>(entry), std::get<1>(entry), std::get<2>(entry)});
  };
  return {{"converged", fit.converged},
          {"message", fit.message},
          {"rms_um", or_null(fit.rms_um)},
          {"rms_urad", or_null(fit.rms_urad)},
          {"observations", fit.observations},
          {"effective_observations", fit.effective_observations},
          {"chi_square", fit.chi_square},
          {"degrees_of_freedom", fit.degrees_of_freedom},
          {"parameters", array_of(fit.parameters, parameter_json)},
          {"nuisances", array_of(fit.nuisances, parameter_json)},
          {"correlations", array_of(fit.correlations, correlation)},
          {"identifiability", identifiability(fit.identifiability)},
          {"noise", array_of(fit.noise, noise)},
          {"contributions", array_of(fit.contributions, share)},
          {"residuals", array_of(fit.residuals, residual)},
          {"neglected_um", or_null(fit.neglected_um)},
          {"implausible", fit.implausible},
          {"notes", fit.notes}};
}

Json squareness(const SquarenessCheck& check) {
  return {{"fit_rad", or_null(check.fit_rad)},
          {"fit_U_rad", or_null(check.fit_U_rad)},
          {"indirect_rad", or_null(check.indirect_rad)},
          {"indirect_U_rad", or_null(check.indirect_U_rad)},
          {"En", or_null(check.En)},
          {"verdict", check.verdict},
          {"reason", check.reason},
          {"travel_mm", or_null(check.travel_mm)},
          {"fit_amplitude_um", or_null(check.fit_amplitude_um)},
          {"indirect_amplitude_um", or_null(check.indirect_amplitude_um)}};
}

Json crosscheck(const Result& result) {
  if (result.squareness) return {{"squareness", squareness(*result.squareness)}};
  if (!result.fit) return {{"squareness", nullptr}};
  SquarenessCheck none;
  none.reason = "this command makes no cross-check";
  return {{"squareness", squareness(none)}};
}

/// nlohmann writes what is not finite as null, which would pass for "not determined".
void require_finite(const Json& json, const std::string& path) {
  if (json.is_number_float() && !std::isfinite(json.get<double>()))
    throw std::logic_error("report: " + path + " is not a finite number");
  if (json.is_object())
    for (const auto& [key, value] : json.items())
      require_finite(value, path.empty() ? key : path + "." + key);
  if (json.is_array())
    for (std::size_t i = 0; i < json.size(); ++i)
      require_finite(json[i], path + "[" + std::to_string(i) + "]");
}

std::string one_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Json report_json(const Result& result, const std::optional<TraceResult>& trace,
                 const std::optional<Details>& details) {
  const RankingResult ranking = result.ranking.value_or(RankingResult{});
  Json report = head(result, "slideway.report/1");
  report["travel"] = result.travel ? travel(*result.travel) : Json(nullptr);
  report["low_band"] = {{"wavelet", result.wavelet},
                        {"level", result.level},
                        {"boundary", result.boundary},
                        {"values", result.low_band_values}};
  report["ranking"] = array_of(ranking.entries, ranking_entry);
  report["candidate_correlations"] = array_of(ranking.among_candidates, candidate_correlation);
  report["ranking_notes"] = ranking.notes;
  report["dominant"] = {{"by_correlation", or_null(result.dominant.by_correlation)},
                        {"by_fit", or_null(result.dominant.by_fit)},
                        {"agree", or_null(result.dominant.agree)},
                        {"doubt", result.dominant.doubt}};
  report["fit"] = result.fit ? fit_json(*result.fit, result) : Json(nullptr);
  report["crosscheck"] = crosscheck(result);
  report["trace"] = trace ? trace_json(*trace) : Json(nullptr);
  if (trace) {
    report["before"] = {{"rms_um", or_null(trace->before_rms_um)},
                        {"rms_urad", or_null(trace->before_rms_urad)},
                        {"parameters", array_of(trace->before, parameter_json)}};
    report["after"] = {{"rms_um", or_null(trace->after_rms_um)},
                       {"rms_urad", or_null(trace->after_rms_urad)},
                       {"parameters", array_of(trace->after, parameter_json)}};
  }
  if (details) add_details(*details, report);
  require_finite(report, "");
  return report;
}

}  // namespace

std::string laid_out(const Json& document) {
  return document.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string data_json(const Result& result) {
  const Json document = head(result, "slideway.data/1");
  require_finite(document, "");
  return laid_out(document) + "\n";
}

std::string json_report(const Result& result, const std::optional<TraceResult>& trace,
                        const std::optional<Details>& details) {
  const Json report = report_json(result, trace, details);
  std::string text = laid_out(report);
  if (details) {  // a line for each profile, not for each number
    const Json curves = curves_json(*details);
    require_finite(curves, "curves");
    text.erase(text.rfind("\n}"));
    text += ",\n  \"curves\": {\n    \"straightness\": " + one_line(curves["straightness"]) +
            ",\n    \"profiles\": [";
    std::string_view separator = "\n      ";
    for (const Json& profile : curves["profiles"]) {
      text.append(separator).append(one_line(profile));
      separator = ",\n      ";
    }
    text += "\n    ]\n  }\n}";
  }
  return text + "\n";
}

std::string json_line(const Result& result, const std::optional<TraceResult>& trace) {
  return one_line(report_json(result, trace, std::nullopt));
}

}  // namespace slideway
