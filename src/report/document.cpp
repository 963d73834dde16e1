#include "slideway/report/document.hpp"

#include <cmath>
#include <tuple>

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

namespace {

constexpr int kDeepest = 32;  // levels of brackets; a report has 7

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
  if (!node["agree"].is_null()) out.agree = node["agree"].truth();
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

std::tuple<std::string, std::string, double> correlation(const Node& node) {
  const auto parts = node.list([](const Node& each) { return each; });
  if (parts.size() != 3) node.fail("two names and a coefficient");
  return {parts[0].text(), parts[1].text(), parts[2].number()};
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
  if (!node["travel"].is_null()) out.travel = travel(node["travel"]);
  const Node band = node["low_band"];
  out.wavelet = band["wavelet"].text();
  out.level = band["level"].small_integer();
  out.boundary = band["boundary"].text();
  out.low_band_values = band["values"].count();
  out.ranking = {node["ranking"].list(ranking_entry),
                 node["candidate_correlations"].list(candidate_correlation),
                 node["ranking_notes"].texts()};
  out.dominant = dominant(node["dominant"]);
  if (!node["fit"].is_null()) out.fit = fit(node["fit"]);
  const Node check = node["crosscheck"]["squareness"];
  if (!check.is_null()) out.squareness = squareness(check);
  return out;
}

Json parsed(const std::filesystem::path& path) {
  const FileBytes bytes(path);
  const auto shallow = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kDeepest)
      throw DataError(path.string() + ": brackets more than " + std::to_string(kDeepest) +
                      " deep; accepted: a report of slideway (--json FILE)");
    return true;
  };
  try {
    return Json::parse(bytes.text(), shallow);
  } catch (const Json::exception& error) {
    throw DataError(path.string() + ": is no JSON (" + printable(error.what(), 120) +
                    "); accepted: a report of slideway (--json FILE)");
  }
}

}  // namespace

Analysis read_report(const std::filesystem::path& path) {
  const Json json = parsed(path);
  const Node report(json, path.string(), "");
  constexpr const char* kSchema = "slideway.report/1";
  const auto schema = json.is_object() ? json.find("schema") : json.end();
  if (schema == json.end() || *schema != kSchema)
    throw DataError(path.string() + ": schema: is " +
                    (schema == json.end() ? "missing" : printable(schema->dump(), 40)) +
                    "; accepted: \"" + kSchema + "\", as --json FILE of slideway writes it");
  Analysis out;
  out.result = result(report);
  if (!report["trace"].is_null()) out.trace = trace_result(report);
  return out;
}

}  // namespace slideway
