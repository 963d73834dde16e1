#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "sample_result.hpp"
#include "slideway/base/error.hpp"
#include "slideway/report/report.hpp"

namespace slideway::html_report_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

Details sample_details() {
  Details details;
  ProfileCurves& curves = details.curves.emplace().profiles.emplace_back();
  curves.profile = "feed2";
  curves.position_mm = curves.contribution_position_mm = {0.0, 5.0, 10.0};
  curves.raw = {1.0, 2.5, 1.0};
  curves.low_band = curves.model_before = {1.0, 2.0, 1.0};
  curves.residual_before = {0.0, 0.1, -0.1};
  curves.effects = {"squareness"};
  curves.contributions = {{0.0, 1.0, 2.0}};
  curves.correlation = {{1.0}};
  curves.lag_mm = 5.0;
  curves.autocorrelation_before = {1.0, 0.2};
  curves.spectrum_before = {{0.1, 0.2}, {0.5, 0.25}};
  curves.approximations = curves.details = {{{0.0, 0.5}, {1.0, 1.5}}};
  details.what_if = {{"feed2", "", 2.0, 0.5, {}, {}},
                     {"feed2", "squareness", 0.5, 0.1, {}, {}},
                     {"feed2", "all", 0.25, 0.1, {}, {}}};
  details.effects = {{.name = "squareness", .formula = "-Δβxz p_x"}};
  return details;
}

TraceResult sample_trace() {
  TraceResult trace;
  trace.verdict = TraceVerdict::explained;
  TraceRound round;
  round.accepted = "thermal_drift";
  round.before_rms_um = 0.2;
  round.after_rms_um = 0.05;
  trace.rounds = {round};
  trace.advice = {"measure a second feed"};
  trace.refused = {{"tool_wear", {}, -20.0, 0.04, 0.15, {}, "the joint fit does not bear it out"}};
  return trace;
}

/// The drift has bent the squareness by ten of its uncertainties.
Analysis sample_analysis() {
  Analysis out{sample_result(), sample_trace(), sample_details()};
  ModelResult &declared = *out.result.declared, &final = *out.result.final;
  declared.rms_um = 0.2;
  final.rms_um = 0.05;
  declared.parameters[0] = fitted("squareness.dbeta_xz", "Δβxz", "rad", 3.0e-6, 1e-8);
  final.parameters[0] = fitted("squareness.dbeta_xz", "Δβxz", "rad", 2.8e-6, 1e-8);
  final.budget = {
      {"squareness.dbeta_xz", "rad", {{"noise of feed2", EvaluationType::type_a, 1.1e-9}}}};
  return out;
}

std::string sample_json() { return json_report(sample_analysis()); }

std::string refusal(const std::string& json) {
  try {
    html_report(json, "report");
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

TEST(HtmlReport, SaysWhatWasMissingAndWhatItHadBent) {
  const std::string page = html_report(sample_analysis());
  EXPECT_THAT(
      page,
      HasSubstr(
          "; the model lacked thermal drift, which had moved squareness Δβxz by 10 times its U."));
  // (3.0 - 2.8)e-6 / 2e-8
  EXPECT_THAT(page, HasSubstr("thermal drift, which moved squareness Δβxz by 10 times its U"));
  EXPECT_THAT(page, HasSubstr("(3.000 ± 0.020)\u00a0×\u00a010<sup>−6</sup>"));  // declared
  EXPECT_THAT(page, HasSubstr("the joint fit does not bear it out"));
  EXPECT_THAT(page, HasSubstr("measure a second feed"));
}

TEST(HtmlReport, HasTheDeclaredModelsNumbersWhereTheyDiffer) {
  Analysis analysis = sample_analysis();
  EXPECT_THAT(html_report(analysis), HasSubstr("declared model</th>"));
  analysis.result.declared->parameters = analysis.result.final->parameters;
  EXPECT_THAT(html_report(analysis), Not(HasSubstr("declared model</th>")));
  analysis.trace.reset();  // a fit that changes U alone
  analysis.result.declared->parameters[0].expanded_uncertainty = 1e-6;
  EXPECT_THAT(html_report(analysis), HasSubstr("declared model</th>"));
}

TEST(HtmlReport, SaysInTheFirstSentenceWhatDominatesAndWhetherTheRunOutAgrees) {
  EXPECT_THAT(
      html_report(sample_analysis()),
      HasSubstr(
          "Squareness, 2.800 ± 0.020 µm/m, dominates; the run-out agrees in amount; the model "));
}

TEST(HtmlReport, PutsWhatHarmsMostFirst) {
  Analysis analysis = sample_analysis();
  analysis.result.crosscheck.squareness->verdict = Consistency::inconsistent;
  Conformity flat;
  flat.what = "flatness";
  flat.verdict = ConformityVerdict::does_not_conform;
  analysis.result.conformity = {flat};
  EXPECT_THAT(html_report(analysis),
              HasSubstr("Flatness does not conform; the run-out contradicts the squareness; "));
}

TEST(HtmlReport, DrawsAStaircaseThroughTheMiddleOfItsSteps) {
  Analysis analysis = sample_analysis();
  ProfileCurves& curves = analysis.details.curves->profiles[0];
  curves.position_mm = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
  curves.raw = {1.0, 1.2, 0.8, 2.0, 2.2, 1.8};
  curves.low_band = {1.0, 1.0, 1.0, 2.0, 2.0, 2.0};
  curves.model_before = curves.low_band;
  curves.residual_before.assign(6, 0.0);
  EXPECT_THAT(html_report(analysis), HasSubstr("\"position\":[1.0,4.0],"));
}

TEST(HtmlReport, HasAMapOfAFaceAndNoneOfASlide) {
  Analysis analysis = sample_analysis();
  ProfileCurves& curves = analysis.details.curves->profiles[0];
  curves.position_mm = {-2.0, -1.0, 0.0, 1.0, 2.0, 3.0};
  curves.raw = curves.low_band = curves.model_before = {2.0, 1.0, 0.0, 1.0, 2.0, 3.0};
  curves.residual_before.assign(6, 0.0);
  analysis.details.setups = {{"feed2", {}}};
  EXPECT_THAT(html_report(analysis), HasSubstr("Face feed2 as a map"));
  for (InputSummary& in : analysis.result.inputs) in.kind = Kind::slide;
  EXPECT_THAT(html_report(analysis), Not(HasSubstr("as a map")));
}

TEST(HtmlReport, HasWhatASignatureNeeds) {
  Analysis analysis = sample_analysis();
  analysis.result.about = {{"operator", "A. Person"}, {"evaluated", "2026-11-23"}};
  analysis.result.conformity.emplace_back().what = "flatness";
  const std::string page = html_report(analysis);
  for (const char* text : {"A. Person", "2026-11-23", "Uncertainty budget of the carriages",
                           "Decision rule", "Signature", "slideway 0.2.0"})
    EXPECT_THAT(page, HasSubstr(text));
}

TEST(HtmlReport, GivesTheSquarenessInThreeUnitsWithTwoDigitsOfUncertainty) {
  const std::string page = html_report(sample_analysis());
  EXPECT_THAT(page, HasSubstr("(2.800 ± 0.020)\u00a0×\u00a010<sup>−6</sup> rad"));
  EXPECT_THAT(page, HasSubstr("2.800 ± 0.020 µm/m"));
  EXPECT_THAT(page, HasSubstr("0.5775 ± 0.0041 ″"));  // 2.8 µm/m * 0.206265
}

TEST(HtmlReport, IsTheSamePageFromTheJson) {
  const std::string page = html_report(sample_analysis());
  const std::string again = html_report(sample_json(), "report");
  const auto differs = std::ranges::mismatch(page, again).in1;
  EXPECT_TRUE(page == again) << std::string(differs, page.end()).substr(0, 80);
}

TEST(HtmlReport, OfASlideSpeaksOfNoFace) {
  Analysis analysis = sample_analysis();
  for (InputSummary& in : analysis.result.inputs) in.kind = Kind::slide;
  const std::string page = html_report(analysis);
  EXPECT_THAT(page, HasSubstr("Straightness of a slide from readings along it"));
  for (const char* word : {"turned face", "workpiece", "Workpiece", "cut radius"})
    EXPECT_THAT(page, Not(HasSubstr(word)));
}

TEST(HtmlReport, AsksForNothingFromOutside) {
  const std::string page = html_report(sample_analysis());
  for (const char* asks : {"<link", " src=\"", "url(", "@import", "sourceMappingURL"})
    EXPECT_EQ(page.find(asks), std::string::npos) << asks;
}

TEST(HtmlReport, EscapesWhatComesFromOutside) {
  Analysis analysis = sample_analysis();
  Result& result = analysis.result;
  const std::string evil = "</script><script>alert('x')</script>\"&\x01";
  result.title = result.inputs[0].name = result.inputs[0].file = evil;
  result.final->parameters[0].symbol = result.final->notes[0] = evil;
  ProfileCurves& curves = analysis.details.curves->profiles[0];
  curves.profile = curves.effects[0] = evil;
  const std::string page = html_report(analysis);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("\x01")));
  EXPECT_THAT(page, HasSubstr("&lt;/script&gt;&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;"));
}

TEST(HtmlReport, IsMadeWithoutCurvesAndWithoutAFitToo) {
  EXPECT_THAT(html_report(Analysis{sample_result()}), HasSubstr("Squareness"));
  Result ranked = sample_result();
  ranked.declared = ranked.final = std::nullopt;
  ranked.crosscheck.squareness = std::nullopt;
  EXPECT_THAT(html_report(Analysis{ranked}), HasSubstr("Ranking only"));
}

TEST(HtmlReport, RefusesWhatIsNoReportInOneLine) {
  EXPECT_THAT(refusal("{"), HasSubstr("report: is no JSON"));
  EXPECT_EQ(refusal("[]"), "report: is array; accepted: an object");
  EXPECT_THAT(refusal(R"({"schema": "other/2"})"),
              HasSubstr("report: schema: is \"other/2\"; accepted: \"slideway.report/2\" or "
                        "\"slideway.brief/1\" or \"slideway.columns/1\""));
  EXPECT_EQ(refusal(R"({"schema": "slideway.report/2"})"),
            "report: version: is missing; accepted: a text");
  EXPECT_THAT(refusal(std::string(1'000'000, '[')), HasSubstr("deep"));
}

TEST(HtmlReport, NamesThePlaceOfAWrongValue) {
  const auto refusal_of = [](const char* place, const Json& value) {
    Json report = Json::parse(sample_json());
    report[Json::json_pointer(place)] = value;
    return refusal(report.dump());
  };
  EXPECT_EQ(refusal_of("/final/parameters/0/at_bound", 3),
            "report: final.parameters[0].at_bound: is number; accepted: true or false");
  EXPECT_EQ(refusal_of("/curves/profiles/0/raw/1", "high"),
            "report: curves.profiles[0].raw[1]: is string; accepted: a number");
}

/// Every value of a document replaced by one of another kind: a page or a DataError, nothing else.
TEST(HtmlReport, AnyWrongValueIsAPageOrARefusal) {
  const Json whole = Json::parse(sample_json());
  const Json flat = whole.flatten();
  int refused = 0;
  for (const auto& [path, value] : flat.items())
    for (const Json& wrong : {Json(nullptr), Json("text"), Json(-1e308), Json::array({1, 2}),
                              Json::object({{"a", 1}}), Json(true)}) {
      Json bent = whole;
      bent[Json::json_pointer(path)] = wrong;
      const std::string message = refusal(bent.dump());
      if (message.empty()) continue;
      ++refused;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace slideway::html_report_test
