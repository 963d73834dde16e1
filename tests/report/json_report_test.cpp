#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/sample_result.hpp"
#include "slideway/report/document.hpp"
#include "slideway/report/report.hpp"

namespace slideway::json_report_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// The example of the contract for schema slideway.report/2, up to the trace.
const Json kContract = Json::parse(R"({
  "schema": "slideway.report/2", "version": "0.2.0", "title": "...", "about": {},
  "assumed": [{ "key": "profile.feed2.free", "value": ["offset", "tilt"], "why": "default" }],
  "inputs": [{ "name": "feed2", "file": "feed2.csv", "sha256": "...", "kind": "face",
               "quantity": "height", "samples": 20000, "missing": 0, "position_min_mm": 0.0,
               "position_max_mm": 10.0, "rms_um": 0.5, "pv_um": 2.0 }],
  "low_band": [{ "profile": "feed2", "wavelet": "db1", "level": 5, "boundary": "symmetric",
                 "values": 625 }],
  "ranking": [{ "effect": "squareness", "profile": "feed2", "raw": 0.83, "low_band": 0.99 }],
  "dominant": { "by_correlation": "squareness", "by_fit": "squareness", "agree": true },
  "declared": {},
  "final": { "effects": ["squareness", "straightness", "thermal_drift"], "converged": true,
    "rms_um": 0.05, "observations": 1250, "effective_observations": 140.0,
    "parameters": [{ "name": "squareness.dbeta_xz", "symbol": "Δβxz", "value": 2.8e-6,
                     "unit": "rad", "standard_uncertainty": 1e-8, "degrees_of_freedom": 60.0,
                     "expanded_uncertainty": 2e-8, "coverage_factor": 2.0, "identifiable": true }],
    "straightness": { "end_point_um": 1.3, "expanded_uncertainty_um": 0.01 },
    "correlations": [["straightness.b2", "straightness.b3", -0.97]],
    "identifiability": { "parameters": 8, "rank": 7, "condition": 120.0,
      "unidentifiable": [{ "combination": { "vertical_straightness.c1": 0.707 },
                           "advice": "..." }] } },
  "crosscheck": { "squareness": { "fit_rad": 2.8e-6, "fit_U_rad": 2e-8, "indirect_rad": 2.8e-6,
                                  "indirect_U_rad": 2e-7, "En": 0.1, "verdict": "consistent" },
                  "profiles": [], "held_out": [] },
  "conformity": []
})");

Json report_of(const Result& result) { return Json::parse(json_report({result})); }

/// Every key of `wanted` is in `given` with a value of the same type; lists by their first entry.
void expect_like(const Json& wanted, const Json& given, const std::string& path) {
  ASSERT_EQ(wanted.type_name(), std::string(given.type_name())) << path;
  ASSERT_EQ(wanted.is_number_float(), given.is_number_float()) << path;
  if (wanted.is_object())
    for (const auto& [key, value] : wanted.items()) {
      ASSERT_TRUE(given.contains(key)) << path << "." << key;
      expect_like(value, given[key], path + "." + key);
    }
  if (wanted.is_array() && !wanted.empty()) {
    ASSERT_FALSE(given.empty()) << path;
    expect_like(wanted[0], given[0], path + "[0]");
  }
}

TEST(JsonReport, HasEveryKeyOfTheContractWithItsType) {
  expect_like(kContract, report_of(sample_result()), "report");
}

TEST(JsonReport, KeepsTheOrderOfTheContract) {
  std::vector<std::string> keys;
  const Json report = report_of(sample_result());
  for (const auto& [key, value] : report.items())
    if (kContract.contains(key) || key == "trace") keys.push_back(key);
  EXPECT_THAT(keys, ElementsAre("schema", "version", "title", "about", "assumed", "inputs",
                                "low_band", "ranking", "dominant", "declared", "final",
                                "crosscheck", "conformity", "trace"));
  EXPECT_TRUE(report["trace"].is_null());
}

TEST(JsonReport, CarriesTheValuesUnchanged) {
  const Json report = report_of(sample_result());
  EXPECT_EQ(report["assumed"][0]["value"], Json({"offset", "tilt"}));
  EXPECT_EQ(report["ranking"][0]["low_band"], 0.99);
  EXPECT_EQ(report["ranking"][0]["running"]["samples"], Json({10, 20}));
  EXPECT_EQ(report["candidate_correlations"][1]["coefficient"], 0.97);
  const Json& final = report["final"];
  EXPECT_EQ(final["parameters"][0]["value"], 2.8e-6);
  EXPECT_EQ(final["correlations"][0], Json::array({"straightness.b2", "straightness.b3", -0.97}));
  EXPECT_EQ(final["identifiability"]["determined"][0]["value"], 2.5e-6);
  EXPECT_EQ(final["noise"][1]["standard_deviation_urad"], 1.5);
  EXPECT_EQ(final["contributions"][0]["rms_um"], 0.4);
  EXPECT_EQ(final["contributions"][1]["rms_urad"], 1.25);
  EXPECT_EQ(final["residuals"][1]["rms_urad"], 1.5);
  EXPECT_EQ(report["crosscheck"]["squareness"]["travel_mm"], 600.0);
}

TEST(JsonReport, WritesNullForWhatCouldNotBeDetermined) {
  const Json report = report_of(sample_result());
  EXPECT_TRUE(report["inputs"][1]["rms_um"].is_null());
  EXPECT_TRUE(report["final"]["noise"][1]["standard_deviation_um"].is_null());
  for (const char* key : {"value", "standard_uncertainty", "expanded_uncertainty"})
    EXPECT_TRUE(report["final"]["parameters"][2][key].is_null()) << key;
}

TEST(JsonReport, HasAllTopKeysWhereOnlyARankingWasAskedFor) {
  const Json report = report_of({});
  for (const auto& [key, value] : kContract.items()) EXPECT_TRUE(report.contains(key)) << key;
  for (const char* key : {"declared", "final", "trace"}) EXPECT_TRUE(report[key].is_null()) << key;
  EXPECT_TRUE(report["crosscheck"]["squareness"].is_null());
}

TEST(JsonReport, ANumberThatIsNotFiniteIsAbsentAndNamedInTheNotesOfItsPart) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Analysis analysis{sample_result()};
  analysis.result.final->parameters[1].standard_uncertainty = HUGE_VAL;
  analysis.result.final->identifiability.condition = HUGE_VAL;
  analysis.result.ranking.entries[0].running.raw[1] = kNan;
  leave_out_non_finite(analysis);
  const std::string text = json_report(analysis);
  const Json report = Json::parse(text);
  const Json& final = report["final"];
  EXPECT_TRUE(final["parameters"][1]["standard_uncertainty"].is_null());
  EXPECT_TRUE(final["identifiability"]["condition"].is_null());
  EXPECT_TRUE(report["ranking"][0]["running"]["raw"][1].is_null());
  EXPECT_THAT(final["notes"], Contains("parameters[1].standard_uncertainty is not a finite number "
                                       "and is left out"));
  EXPECT_THAT(final["notes"], Contains(HasSubstr("identifiability.condition")));
  EXPECT_THAT(report["notes"], ElementsAre(HasSubstr("ranking[0].running.raw")));
  EXPECT_THAT(report["declared"]["notes"], Not(Contains(HasSubstr("finite"))));
  EXPECT_EQ(json_report(parse_report(text, "report")), text);
  EXPECT_THAT(text_report(analysis), HasSubstr("straightness b_2"));
}

TEST(JsonReport, AProbabilityThatUnderflowsIsNot0) {
  Analysis analysis{sample_result(), TraceResult{}};
  analysis.result.ranking.entries[0].p_value = 0.0;
  analysis.result.final->noise[0].ljung_box_p = 0.0;
  analysis.trace->rounds.emplace_back().p_value = 1e-320;
  const std::string text = json_report(analysis);
  const Json report = Json::parse(text);
  constexpr double kLeast = std::numeric_limits<double>::min();
  EXPECT_EQ(report["ranking"][0]["p_value"], kLeast);
  EXPECT_EQ(report["final"]["noise"][0]["ljung_box_p"], kLeast);
  EXPECT_EQ(report["trace"]["rounds"][0]["p_value"], kLeast);
  EXPECT_EQ(report["final"]["noise"][1]["ljung_box_p"], 0.5);
  EXPECT_EQ(json_report(parse_report(text, "report")), text);
  EXPECT_GT(Json::parse(json_brief(analysis))["trace"]["rounds"][0]["p_value"].get<double>(), 0.0);
}

TEST(JsonReport, IsTheSameTextEveryTimeAndEndsWithANewline) {
  const std::string text = json_report({sample_result()});
  EXPECT_EQ(text, json_report({sample_result()}));
  EXPECT_EQ(text.back(), '\n');
  EXPECT_EQ(text.substr(0, 15), "{\n  \"schema\": \"");
}

TEST(JsonReport, StaysValidWhereAFileNameIsNotUtf8) {
  Result result = sample_result();
  result.inputs[0].file =
      "fl\xE4"
      "che.csv";
  EXPECT_NO_THROW(report_of(result));
}

}  // namespace
}  // namespace slideway::json_report_test
