#include "slideway/report/document.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/temporary_folder.hpp"
#include "report/sample_result.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/report.hpp"

namespace slideway::document_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

TraceResult sample_trace() {
  TriedEffect tried{"cup", {}, -20.0, 0.04, 0.15, {fitted("cup.sag_um", "A", "um", 0.2, 0.1)},
                    "why"};
  TraceRound round;
  round.accepted = "thermal_drift";
  round.ambiguous_with = {"tool_wear"};
  round.before_rms_um = 0.2;
  round.after_holdout_rms_um = 0.05;
  round.candidates = {tried};
  TraceResult trace;
  trace.verdict = TraceVerdict::unnamed;
  trace.gates = {{"delta_bic", 10.0}};
  trace.fragile = {"delta_bic", 12.5, TraceVerdict::nothing_missing};
  trace.left = {{"cup", "straightness makes it"}};
  trace.rounds = {round};
  Unnamed left;
  left.rms_urad = 0.25;
  left.pv_urad = 0.75;
  left.log_evidence = {{"t", 0.0}, {"r", -12.5}};
  trace.unnamed = left;
  trace.advice = {"cut again"};
  trace.not_testable = {{"traverse_periodic", "traverse_mm_per_s"}};
  trace.not_separable = {{"cup", "tool_wear"}};
  trace.refused = {tried};
  trace.detection_limits = {{"cup", "sag_um", "um", 0.1, "", {}},
                            {"thermal_drift",
                             "amplitude_um",
                             "um",
                             0.2,
                             "time_constant_s = 9",
                             {{3.0, 0.1}, {9.0, 0.2}}}};
  return trace;
}

class Document : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& text) const {
    const std::filesystem::path path = folder_.path() / "result.json";
    write_file(path, text);
    return path;
  }

  /// What a reader says of the sample with one value replaced, at a JSON pointer.
  [[nodiscard]] std::string refusal(const char* place, const Json& value) const {
    Json report = Json::parse(json_report({sample_result(), sample_trace()}));
    report[Json::json_pointer(place)] = value;
    return refusal(report.dump());
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      read_report(file(text));
    } catch (const DataError& error) {
      return error.what();
    }
    return "read";
  }

  TemporaryFolder folder_;
};

TEST_F(Document, ReadBackMakesTheSameBytes) {
  Result result = sample_result();
  result.about = {{"machine", "LT-3"}};
  result.travel = {Lever::split, 0.0, 600.0, 0.0, std::nullopt};
  result.dominant.doubt = "two lead";
  result.final->implausible = "2 mm over 10 mm";
  result.crosscheck.profiles = {{{"run2", "run3"}, "straightness", 0.4, Consistency::consistent}};
  result.crosscheck.held_out = {{"run5", 1.4, 0.02, 0.8, {}, 620.0, HeldOutVerdict::does_not_fit}};
  result.conformity = {{.what = "flatness",
                        .value_um = 2.1,
                        .U_um = 0.1,
                        .limit_um = 3.0,
                        .verdict = ConformityVerdict::conforms}};
  for (const std::string& text :
       {json_report({result}), json_report({result, sample_trace()}), json_report({})})
    EXPECT_EQ(json_report(read_report(file(text))), text);
}

// On one line, as a batch has it, too.
TEST_F(Document, ReadBackOfALineMakesTheSameLine) {
  const std::string line = json_line({sample_result(), sample_trace()});
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(json_line(parse_report(line, "line")), line);
}

TEST_F(Document, PassesOverKeysItDoesNotKnow) {
  EXPECT_EQ(refusal("/inputs/0/colour", "blue"), "read");
}

TEST_F(Document, TakesOutWhatATerminalWouldObeyButLineBreaks) {
  Result result;
  result.title = "µm\x1b[31m\r\n";
  EXPECT_EQ(read_report(file(json_report({result}))).result.title, "µm?[31m?\n");
}

TEST_F(Document, NamesPlaceAndWhatIsAccepted) {
  EXPECT_THAT(refusal("/final/parameters/1/unit", 3),
              HasSubstr("result.json: final.parameters[1].unit: is number; accepted: a text"));
  EXPECT_THAT(refusal("/final/parameters/1/value", "NaN"),
              HasSubstr("final.parameters[1].value: is string; accepted: a number"));
  EXPECT_THAT(refusal("/inputs/0/samples", -4), HasSubstr("accepted: a whole number"));
  EXPECT_THAT(refusal("/low_band/0/level", 1e300), HasSubstr("low_band[0].level"));
  EXPECT_THAT(refusal("/trace/verdict", "certain"),
              HasSubstr("trace.verdict: is string; accepted: \"nothing_missing\" or "));
  EXPECT_THAT(refusal("/trace/rounds/0/accepted", nullptr),
              HasSubstr("trace.rounds[0].accepted: is missing"));
  EXPECT_THAT(refusal("/final/correlations/0", Json::array({"a"})),
              HasSubstr("final.correlations[0]"));
}

TEST_F(Document, RefusesListsThatBelongTogetherOfUnlikeLengths) {
  Analysis analysis{sample_result(), sample_trace()};
  Straightness& form = analysis.result.final->straightness.emplace();
  form.curve.position_mm = form.curve.deviation_um =
      form.curve.expanded_uncertainty_um = {0.0, 1.0};
  form.curve.tip_um = form.curve.tip_expanded_uncertainty_um = {0.0, 1.0};
  ProfileCheck& check = analysis.result.crosscheck.profiles.emplace_back();
  check.value_um = check.U_um = {1.0, 2.0};
  UnnamedCurve& left = analysis.trace->unnamed->curve;
  left.at = left.residual = left.expanded_uncertainty = {1.0, 2.0};
  const Json report = Json::parse(json_report(analysis));
  ASSERT_EQ(refusal(report.dump()), "read");
  for (const std::string list :
       {"/final/straightness/curve/position_mm", "/final/straightness/curve/deviation_um",
        "/final/straightness/curve/expanded_uncertainty_um", "/final/straightness/curve/tip_um",
        "/final/straightness/curve/tip_expanded_uncertainty_um", "/crosscheck/profiles/0/value_um",
        "/crosscheck/profiles/0/U_um", "/trace/unnamed/curve/at", "/trace/unnamed/curve/residual",
        "/trace/unnamed/curve/expanded_uncertainty"})
    for (const Json& value : {Json::array(), Json::array({1.0}), Json::array({1.0, 2.0, 3.0})}) {
      Json changed = report;
      changed.at(Json::json_pointer(list)) = value;
      EXPECT_THAT(refusal(changed.dump()), HasSubstr("accepted: as many numbers as")) << list;
    }
}

TEST_F(Document, RefusesWhatIsNoReport) {
  EXPECT_THAT(refusal("/schema", "slideway.diff/1"), HasSubstr("\"slideway.report/2\""));
  for (const char* text : {"", "[]", "3", "{}", "{\"schema\": 1}", "\xff\xfe", "null"})
    EXPECT_THAT(refusal(std::string(text)), HasSubstr("accepted: ")) << text;
  EXPECT_THAT(refusal("{\"schema\": \"slideway.report/2\", \"title\": 1e999}"),
              HasSubstr("is no JSON"));
  EXPECT_THAT(refusal(std::string(1'000'000, '[')), HasSubstr("deep"));
  EXPECT_THROW(read_report(folder_.path() / "none.json"), DataError);
  EXPECT_THROW(read_report(folder_.path()), DataError);
}

TEST_F(Document, RefusesEveryTruncationInOneLine) {
  const std::string text = json_report({sample_result(), sample_trace()});
  for (std::size_t size = 0; size + 2 < text.size(); size += 53) {
    const std::string why = refusal(text.substr(0, size));
    EXPECT_NE(why, "read") << size;
    EXPECT_EQ(why.find('\n'), std::string::npos) << why;
  }
}

}  // namespace
}  // namespace slideway::document_test
