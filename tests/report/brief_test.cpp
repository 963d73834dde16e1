#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "brief.hpp"
#include "contract_types.hpp"
#include "sample_result.hpp"
#include "slideway/base/error.hpp"
#include "slideway/report/document.hpp"
#include "slideway/report/report.hpp"

namespace slideway::brief_test {
namespace {

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

Analysis sample_analysis() {
  Analysis out{sample_result(), TraceResult()};
  out.trace->verdict = TraceVerdict::ambiguous;
  TraceRound& round = out.trace->rounds.emplace_back();
  round.accepted = "thermal_drift";
  round.ambiguous_with = {"tool_wear"};
  round.delta_bic = -123.456789;
  round.p_value = 0.0;
  round.stability = 0.0;
  out.trace->detection_limits = {
      {"thermal_drift", "amplitude_um", "µm", 0.0123456, "time_constant_s = 120", {}, {}},
      {"cup", "sag_um", "µm", std::nullopt, "", {}, {}}};
  return out;
}

Json brief_of(Analysis analysis) { return Json::parse(json_brief(std::move(analysis))); }

TEST(Brief, HasWhatATableShows) {
  const Json brief = brief_of(sample_analysis());
  EXPECT_EQ(brief["schema"], "slideway.brief/1");
  const Json& trace = brief["trace"];
  EXPECT_EQ(trace["verdict"], "ambiguous");
  EXPECT_EQ(trace["rounds"][0]["ambiguous_with"], Json::array({"tool_wear"}));
  EXPECT_EQ(trace["rounds"][0]["delta_bic"], -123.46);
  EXPECT_EQ(trace["rounds"][0]["stability"], 0.0) << "a number is there, if it is 0 too";
  EXPECT_EQ(trace["detection_limits"][0],
            Json({{"effect", "thermal_drift"}, {"unit", "µm"}, {"value", 0.0123}}));
  EXPECT_FALSE(trace["detection_limits"][1].contains("value"));
  EXPECT_EQ(brief["final"]["parameters"].size(), sample_result().final->parameters.size());
  EXPECT_FALSE(brief.contains("declared"));
  EXPECT_FALSE(brief.contains("curves"));
}

TEST(Brief, HasChecksThatFailAndTheClosest) {
  Analysis analysis = sample_analysis();
  const auto check = [](const char* what, double En, Consistency verdict) {
    return ProfileCheck{{"a", "b"}, what, En, verdict, {}, {}};
  };
  analysis.result.crosscheck.profiles = {check("first", 0.2, Consistency::consistent),
                                         check("second", 0.9, Consistency::consistent),
                                         check("third", 0.1, Consistency::inconsistent)};
  const Json brief = brief_of(analysis);
  const Json& checks = brief["crosscheck"]["profiles"];
  ASSERT_EQ(checks.size(), 2U);
  EXPECT_EQ(checks[0]["what"], "second");
  EXPECT_EQ(checks[1]["what"], "third");
}

TEST(Brief, MakesAPage) {
  const std::string page = html_report(json_brief(sample_analysis()), "line");
  EXPECT_THAT(page, HasSubstr("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr("thermal drift"));
  EXPECT_THAT(page, HasSubstr("squareness.dbeta_xz"));
}

TEST(Brief, WhoeverReadsAWholeReportRefusesIt) {
  try {
    static_cast<void>(parse_report(json_brief(sample_analysis()), "line"));
    FAIL();
  } catch (const DataError& error) {
    EXPECT_THAT(error.what(), HasSubstr("schema: is \"slideway.brief/1\"; accepted: "
                                        "\"slideway.report/2\""));
  }
}

// A page is made of what others wrote, too.
TEST(Brief, APageOfPartsOrOfOtherTypesIsRefused) {
  const Json sound = brief_of(sample_analysis());
  for (const char* place : {"/trace", "/final", "/inputs", "/crosscheck", "/trace/rounds",
                            "/trace/detection_limits/0", "/final/parameters/0", "/version"}) {
    for (const Json& value : {Json(1), Json("x"), Json::array({1}), Json({{"a", 1}}), Json()}) {
      Json changed = sound;
      changed[Json::json_pointer(place)] = value;
      try {
        static_cast<void>(html_report(changed.dump(), "line"));
      } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("line: "));
      }
    }
  }
}

TEST(Brief, KeysAreThoseOfTheReport) {
  for (const std::string_view record : brief_names()) {
    const auto known = std::ranges::find(report_records(), record, &ContractRecord::name);
    ASSERT_NE(known, report_records().end()) << record;
    for (const std::string& key : brief_keys(record))
      EXPECT_TRUE(std::ranges::count(known->members, key, &ContractMember::key) == 1)
          << record << "." << key;
  }
}

}  // namespace
}  // namespace slideway::brief_test
