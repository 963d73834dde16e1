#include "slideway/report/document.hpp"

#include <algorithm>

#include "document_node.hpp"
#include "slideway/base/file.hpp"

namespace slideway {

FittedParameter fitted_parameter(const Node& node) {
  FittedParameter p;
  p.name = node["name"].text();
  p.symbol = node["symbol"].text();
  p.unit = node["unit"].text();
  p.standard_name = node["standard_name"].text();
  p.value = node["value"].number_or_null();
  p.standard_uncertainty = node["standard_uncertainty"].number_or_null();
  p.expanded_uncertainty = node["expanded_uncertainty"].number_or_null();
  p.coverage_factor = node["coverage_factor"].number();
  p.degrees_of_freedom = node["degrees_of_freedom"].number_or_null();
  p.identifiable = node["identifiable"].truth();
  p.at_bound = node["at_bound"].truth();
  return p;
}

Correlation correlation(const Node& node) {
  const auto parts = node.entries();
  if (parts.size() != 3) node.fail("two names and a coefficient");
  return {parts[0].text(), parts[1].text(), parts[2].number()};
}

namespace {

constexpr int kDeepest = 32;  // levels of brackets; a report has 7
constexpr const char* kAccepted = "a report of slideway (--json FILE)";

OutlierSummary outlier(const Node& node) {
  return {node["row"].count(), node["value"].number(), node["expected"].number(),
          node["unit"].text(), node["kind"].text()};
}

InputSummary input(const Node& node) {
  InputSummary in;
  in.name = node["name"].text();
  in.file = node["file"].text();
  in.format = node["format"].text();
  in.sha256 = node["sha256"].text();
  in.kind = node["kind"].text();
  in.quantity = node["quantity"].text();
  in.role = node["role"].text();
  in.samples = node["samples"].count();
  in.missing = node["missing"].count();
  in.left_out = node["left_out"].count();
  in.outlier_count = node["outlier_count"].count();
  in.outliers = node["outliers"].list(outlier);
  in.position_min_mm = node["position_min_mm"].number();
  in.position_max_mm = node["position_max_mm"].number();
  in.rms_um = node["rms_um"].number_or_null();
  in.pv_um = node["pv_um"].number_or_null();
  in.rms_urad = node["rms_urad"].number_or_null();
  in.pv_urad = node["pv_urad"].number_or_null();
  in.notes = node["notes"].texts();
  return in;
}

MisclosureSummary misclosure(const Node& node) {
  return {node["profile"].text(),
          node["x_mm"].number(),
          node["y_mm"].number(),
          node["difference_um"].number_or_null(),
          node["closure_um"].number_or_null(),
          node["standard_uncertainty_um"].number_or_null()};
}

RepeatSummary repeat(const Node& node) {
  return {node["a"].text(),
          node["b"].text(),
          node["stations"].count(),
          node["x_mm"].number(),
          node["y_mm"].number(),
          node["difference_um"].number(),
          node["standard_uncertainty_um"].number(),
          node["limit"].number(),
          node["verdict"].text()};
}

ClosureSummary closure(const Node& node) {
  return {node["lines"].count(),        node["places"].count(),
          node["redundancy"].count(),   node["verdict"].text(),
          node["false_alarm"].number(), node["limit"].number_or_null(),
          node["tied"].truth(),         node["readings"].list(misclosure),
          node["repeats"].list(repeat), node["suspects"].texts(),
          node["notes"].texts()};
}

TravelSummary travel(const Node& node) {
  return {node["lever"].text(), node["slide_min_mm"].number(), node["slide_max_mm"].number(),
          node["spindle_position_mm"].number_or_null(), node["overhang_mm"].number_or_null()};
}

Ranking ranking_entry(const Node& node) {
  Ranking entry;
  entry.effect = node["effect"].text();
  entry.profile = node["profile"].text();
  entry.raw = node["raw"].number();
  entry.low_band = node["low_band"].number();
  entry.lag_mm = node["lag_mm"].number();
  entry.lag_coefficient = node["lag_coefficient"].number();
  entry.effective_observations = node["effective_observations"].number();
  entry.p_value = node["p_value"].number();
  const Node running = node["running"];
  entry.running = {running["samples"].list([](const Node& each) { return each.count(); }),
                   running["raw"].numbers(), running["low_band"].numbers()};
  return entry;
}

CandidateCorrelation candidate_correlation(const Node& node) {
  return {node["a"].text(), node["b"].text(), node["profile"].text(), node["coefficient"].number()};
}

Dominant dominant(const Node& node) {
  Dominant out;
  out.by_correlation = node["by_correlation"].text_or_null();
  out.by_fit = node["by_fit"].text_or_null();
  if (node.has("agree")) out.agree = node["agree"].truth();
  out.doubt = node["doubt"].text_or_null().value_or("");
  return out;
}

UndeterminedDirection direction(const Node& node) {
  return {node["combination"].named_numbers(), node["advice"].text()};
}

DeterminedCombination determined(const Node& node) {
  return {node["combination"].named_numbers(), node["value"].number(),
          node["standard_uncertainty"].number(), node["expanded_uncertainty"].number(),
          node["unit"].text()};
}

NoiseSummary noise(const Node& node) {
  NoiseSummary out;
  out.profile = node["profile"].text();
  out.scaling = node["scaling"].text();
  out.order = node["order"].small_integer();
  out.standard_deviation_um = node["standard_deviation_um"].number_or_null();
  out.standard_deviation_urad = node["standard_deviation_urad"].number_or_null();
  out.correlation_mm = node["correlation_mm"].number();
  out.effective_observations = node["effective_observations"].number();
  out.ljung_box_p = node["ljung_box_p"].number();
  return out;
}

/// "rms_um" or, of a slope profile, "rms_urad".
Node in_micro(const Node& node, const std::string& what) {
  const Node um = node[what + "_um"];
  return um.is_null() ? node[what + "_urad"] : um;
}

Contribution contribution(const Node& node) {
  return {node["effect"].text(), node["profile"].text(), in_micro(node, "rms").number(),
          node["share"].number()};
}

ResidualSummary residual(const Node& node) {
  return {node["profile"].text(), node["role"].text(), in_micro(node, "rms").number(),
          in_micro(node, "pv").number(), node["rms_um"].is_null() ? "urad" : "um"};
}

FitResult fit(const Node& node) {
  FitResult out;
  out.converged = node["converged"].truth();
  out.message = node["message"].text();
  out.rms_um = node["rms_um"].number_or_null();
  out.rms_urad = node["rms_urad"].number_or_null();
  out.observations = node["observations"].count();
  out.effective_observations = node["effective_observations"].number();
  out.chi_square = node["chi_square"].number();
  out.degrees_of_freedom = node["degrees_of_freedom"].number();
  out.parameters = node["parameters"].list(fitted_parameter);
  out.nuisances = node["nuisances"].list(fitted_parameter);
  out.correlations = node["correlations"].list(correlation);
  const Node what = node["identifiability"];
  out.identifiability = {what["parameters"].count(), what["rank"].count(),
                         what["condition"].number(), what["unidentifiable"].list(direction),
                         what["determined"].list(determined)};
  out.noise = node["noise"].list(noise);
  out.contributions = node["contributions"].list(contribution);
  out.residuals = node["residuals"].list(residual);
  out.neglected_um = node["neglected_um"].number_or_null();
  out.implausible = node["implausible"].text_or_null().value_or("");
  out.notes = node["notes"].texts();
  return out;
}

SquarenessCheck squareness(const Node& node) {
  return {node["fit_rad"].number_or_null(),
          node["fit_U_rad"].number_or_null(),
          node["indirect_rad"].number_or_null(),
          node["indirect_U_rad"].number_or_null(),
          node["En"].number_or_null(),
          node["verdict"].text(),
          node["reason"].text(),
          node["travel_mm"].number_or_null(),
          node["fit_amplitude_um"].number_or_null(),
          node["indirect_amplitude_um"].number_or_null()};
}

Result result(const Node& node) {
  Result out;
  out.title = node["title"].text();
  out.version = node["version"].text();
  out.inputs = node["inputs"].list(input);
  if (node.has("closure")) out.closure = closure(node["closure"]);
  if (node.has("travel")) out.travel = travel(node["travel"]);
  const Node band = node["low_band"];
  out.wavelet = band["wavelet"].text();
  out.level = band["level"].small_integer();
  out.boundary = band["boundary"].text();
  out.low_band_values = band["values"].count();
  out.ranking = {node["ranking"].list(ranking_entry),
                 node["candidate_correlations"].list(candidate_correlation),
                 node["ranking_notes"].texts()};
  out.dominant = dominant(node["dominant"]);
  if (node.has("fit")) out.fit = fit(node["fit"]);
  const Node check = node["crosscheck"]["squareness"];
  if (!check.is_null()) out.squareness = squareness(check);
  return out;
}

}  // namespace

Json parse_document(std::string_view text, std::initializer_list<std::string_view> schemas) {
  const auto shallow = [](int depth, Json::parse_event_t, const Json&) {
    if (depth > kDeepest)
      throw DataError("brackets more than " + std::to_string(kDeepest) +
                      " deep; accepted: " + kAccepted);
    return true;
  };
  Json json = [&] {
    try {
      return Json::parse(text, shallow);
    } catch (const Json::exception& error) {
      throw DataError("is no JSON (" + printable(error.what(), 120) + "); accepted: " + kAccepted);
    }
  }();
  std::vector<std::string> accepted;
  for (const std::string_view each : schemas) accepted.push_back('"' + std::string(each) + '"');
  const std::string known = joined(accepted, " or ") + ", as --json FILE of slideway writes it";
  const Node schema = Node(json)["schema"];
  if (schema.is_null()) schema.fail(known);
  if (std::ranges::find(schemas, schema.verbatim()) == schemas.end())
    throw DataError("schema: is \"" + printable(schema.verbatim(), 40) + "\"; accepted: " + known);
  return json;
}

const std::vector<FittedParameter>& final_parameters(const Analysis& analysis) {
  static const std::vector<FittedParameter> kNone;
  if (analysis.trace) return analysis.trace->after;
  return analysis.result.fit ? analysis.result.fit->parameters : kNone;
}

Analysis read_report(const std::filesystem::path& path) {
  const FileBytes bytes(path);
  return read_document(bytes.text(), path.string(), {kReportSchema}, [](const Node& report) {
    Analysis out;
    out.result = result(report);
    if (report.has("trace")) out.trace = trace_result(report);
    return out;
  });
}

}  // namespace slideway
