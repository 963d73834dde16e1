#include <gmock/gmock.h>

#include <clocale>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"
#include "slideway/report/layout.hpp"

namespace slideway::identify_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kFullTravel = shipped("problems/paper-600mm/problem.toml");
const std::string kSmallFace = shipped("problems/paper-face-10mm/problem.toml");

class Identify : public ProgramTest {};

TEST_F(Identify, SaysThatPriorsContradictEachOther) {
  folder_.file("face.csv", face_csv(64));
  const auto said = [&](const std::string& priors) {
    folder_.file("problem.toml",
                 ProblemText{.effect = "[[effect]]\nname = \"straightness\"\ndegree = 2\n"
                                       "priors = [" +
                                       priors + "]\n"}
                     .text());
    return json::parse(run({"fit", "problem.toml", "--json", "-"}).out)["final"]["notes"].dump();
  };
  const std::string one = "{ parameter = \"b2\", value = 0, standard_uncertainty = 1e-6 }";
  // Between two priors 7e4 standard uncertainties apart, whatever the data say.
  const std::string other = "{ parameter = \"b2\", value = 0.1, standard_uncertainty = 1e-6 }";
  EXPECT_THAT(said(one + ", " + other), HasSubstr("the priors (straightness.b2) contradict"));
  EXPECT_THAT(said(one), testing::Not(HasSubstr("contradict")));
}

// The report example of the interface, up to crosscheck; of a list each element must have the keys.
const json kKeys = json::parse(R"({
  "schema": 0, "version": 0, "title": 0, "about": {}, "assumed": [{"key": 0, "value": 0, "why": 0}],
  "inputs": [{"name": 0, "file": 0, "sha256": 0, "kind": 0, "quantity": 0, "samples": 0,
              "missing": 0, "position_min_mm": 0, "position_max_mm": 0, "rms_um": 0, "pv_um": 0}],
  "low_band": [{"profile": 0, "wavelet": 0, "level": 0, "boundary": 0, "values": 0}],
  "ranking": [{"effect": 0, "profile": 0, "raw": 0, "low_band": 0}],
  "dominant": {"by_correlation": 0, "by_fit": 0, "agree": 0},
  "declared": {"effects": 0, "parameters": 0},
  "final": {"effects": 0, "converged": 0, "rms_um": 0, "observations": 0, "effective_observations": 0,
    "parameters": [{"name": 0, "symbol": 0, "value": 0, "unit": 0, "standard_uncertainty": 0,
                    "degrees_of_freedom": 0, "expanded_uncertainty": 0, "coverage_factor": 0,
                    "identifiable": 0}],
    "straightness": {"end_point_um": 0, "least_squares_um": 0, "minimum_zone_um": 0,
                     "expanded_uncertainty_um": 0},
    "correlations": 0,
    "identifiability": {"parameters": 0, "rank": 0, "condition": 0,
                        "unidentifiable": [{"combination": 0, "advice": 0}]}},
  "crosscheck": {"squareness": {"fit_rad": 0, "fit_U_rad": 0, "indirect_rad": 0,
                                "indirect_U_rad": 0, "En": 0, "verdict": 0},
                 "profiles": [], "held_out": []},
  "conformity": [],
  "trace": 0
})");

void expect_keys(const json& wanted, const json& found, const std::string& place) {
  if (wanted.is_array()) {
    ASSERT_TRUE(found.is_array()) << place;
    if (wanted.empty()) return;
    for (const json& element : found) expect_keys(wanted[0], element, place + "[]");
  } else if (wanted.is_object()) {
    ASSERT_TRUE(found.is_object()) << place;
    for (const auto& [key, value] : wanted.items()) {
      ASSERT_TRUE(found.contains(key)) << place << "." << key;
      expect_keys(value, found[key], place + "." + key);
    }
  }
}

TEST_F(Identify, WritesNothingButTheReportAsJsonToStdout) {
  const ProgramRun done = run({"identify", kFullTravel, "--no-trace", "--json", "-"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.err, "");
  const json report = json::parse(done.out);  // throws on anything behind it
  expect_keys(kKeys, report, "");
  EXPECT_EQ(report["schema"], "slideway.report/2");
  EXPECT_EQ(report["version"], "0.2.0");
  EXPECT_TRUE(report["trace"].is_null());
  EXPECT_FALSE(report["inputs"].empty());
  EXPECT_FALSE(report["ranking"].empty());
  EXPECT_EQ(run({"identify", kFullTravel, "--no-trace", "--json", "-", "--quiet"}).out, done.out);
}

TEST_F(Identify, HasTheKeysOfWhatCanNotBeDetermined) {
  const ProgramRun done =
      run({"identify", shipped("problems/three-levels/problem.toml"), "--no-trace", "--json", "-"});
  const json report = json::parse(done.out);
  expect_keys(kKeys, report, "");
  EXPECT_FALSE(report["final"]["identifiability"]["unidentifiable"].empty());
  for (const json& parameter : report["final"]["parameters"])
    EXPECT_EQ(parameter["value"].is_number(), parameter["identifiable"].get<bool>());
}

TEST_F(Identify, FindsTheSquarenessOfTheFullTravel) {
  const ProgramRun done = run({"identify", kFullTravel, "--no-trace", "--json", "-"});
  const json report = json::parse(done.out);
  EXPECT_EQ(report["dominant"], (json{{"by_correlation", "squareness"},
                                      {"by_fit", "squareness"},
                                      {"agree", true},
                                      {"doubt", ""}}));
  const json check = report["crosscheck"]["squareness"];
  // 2.8e-6 rad went into the data; U is 95 %, twice that fails with a normal error by 6e-5.
  EXPECT_NEAR(check["fit_rad"].get<double>(), 2.8e-6, 2.0 * check["fit_U_rad"].get<double>());
  EXPECT_LT(check["fit_U_rad"].get<double>(), 1e-7);  // the problem's README: u about 2e-8
  EXPECT_EQ(check["verdict"], "consistent");
}

TEST_F(Identify, GivesTheSameBytesASecondTime) {
  for (const std::string& problem : {kFullTravel, kSmallFace}) {
    const std::vector<std::string> text{"identify", problem, "--no-trace"};
    const std::vector<std::string> as_json{"identify", problem, "--no-trace", "--json", "-"};
    EXPECT_EQ(run(text).out, run(text).out);
    EXPECT_EQ(run(as_json).out, run(as_json).out);
  }
}

TEST_F(Identify, KeepsItsTextWithin80Columns) {
  for (const char* problem :
       {"paper-600mm/problem.toml", "paper-600mm/paper.toml", "paper-face-10mm/problem.toml",
        "three-levels/problem.toml", "three-levels/split.toml", "milling-machine-way/problem.toml",
        "paper-experiment/problem.toml"}) {
    const ProgramRun done =
        run({"identify", shipped(std::string("problems/") + problem), "--no-trace"});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("\nslideway 0.2.0: "));
    for (const std::string& line : lines_of(done.out)) EXPECT_LE(code_points(line), 80U) << line;
  }
}

TEST_F(Identify, StrictIsContentWithAPositiveVerdict) {
  const ProgramRun done = run({"identify", kFullTravel, "--no-trace", "--strict"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, run({"identify", kFullTravel, "--no-trace"}).out);
}

TEST_F(Identify, StrictReportsANegativeVerdictByItsExitCode) {
  const ProgramRun strict =
      run({"identify", kSmallFace, "--no-trace", "--strict", "--json", "report.json"});
  EXPECT_EQ(strict.exit_code, 4);
  EXPECT_EQ(strict.err, "");
  EXPECT_THAT(strict.out, HasSubstr("INCONSISTENT"));
  const json report = json::parse(contents(path("report.json")));
  EXPECT_EQ(report["crosscheck"]["squareness"]["verdict"], "inconsistent");
  EXPECT_EQ(run({"identify", kSmallFace, "--no-trace"}).exit_code, 0);
}

TEST_F(Identify, StrictIsContentWithWhatAConventionFixes) {
  const std::string problem = shipped("problems/milling-machine-way/problem.toml");
  const ProgramRun done = run({"identify", problem, "--no-trace", "--strict"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_THAT(done.out, HasSubstr("not determined"));  // b0 and b1: the reference line
}

TEST_F(Identify, StrictIsNegativeWhereSomethingIsNotDetermined) {
  const std::string problem = shipped("problems/three-levels/problem.toml");
  EXPECT_EQ(run({"identify", problem, "--no-trace", "--strict"}).exit_code, 4);
  EXPECT_EQ(run({"fit", problem, "--strict"}).exit_code, 4);
}

TEST_F(Identify, LeavesOutSpikesWhereItIsAsked) {
  folder_.file("face.csv", face_csv(64, 30, "30,-9000\n"));
  folder_.file("problem.toml", ProblemText{.profile_more = "leave_out = \"spikes\"\n"}.text());
  const ProgramRun done = run({"identify", "problem.toml", "--no-trace", "--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json input = json::parse(done.out)["inputs"][0];
  EXPECT_EQ(input["samples"], 63);
  EXPECT_THAT(input.dump(),
              HasSubstr("1 sample that neighbours contradict, left out: data row 31"));
}

TEST_F(Identify, NeedsNoUnitsWhereTheFileStatesThem) {
  folder_.file("face.csv", face_csv(64));
  ASSERT_EQ(run({"convert", "face.csv", "face.x3p"}).exit_code, 0);
  folder_.file("problem.toml", ProblemText{.file = "face.x3p", .columns = "", .units = ""}.text());
  const ProgramRun done = run({"identify", "problem.toml", "--no-trace", "--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json input = json::parse(done.out)["inputs"][0];
  EXPECT_EQ(input["samples"], 64);
  EXPECT_DOUBLE_EQ(input["position_max_mm"], 63.0);
}

TEST_F(Identify, DoesNotKnowTheLocale) {
  const char* kGerman = "de_DE.UTF-8";  // a decimal comma, a point between thousands
  const bool installed = std::setlocale(LC_ALL, kGerman) != nullptr;
  std::setlocale(LC_ALL, "C");
  if (!installed) GTEST_SKIP() << "locale " << kGerman << " is not installed";
  const std::string columns = shipped("data/axis-ranking.csv");
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"identify", kFullTravel, "--no-trace"},
           {"identify", kFullTravel, "--no-trace", "--json", "-"},
           {"rank", columns, "--signal", "measured", "--candidates", "error_x", "error_y"},
           {"decompose", columns, "--level", "3", "--out", "-"},
           {"effects"},
           {"decompose", "--help"},
           {"identify", "gone.toml"}}) {
    const auto run_in = [&](const std::string& locale) {
      return run_program(arguments, {folder_.path(), {}, {{"LC_ALL", locale}, {"LANG", locale}}});
    };
    const ProgramRun german = run_in(kGerman), plain = run_in("C");
    EXPECT_EQ(german.out, plain.out) << arguments[0];
    EXPECT_EQ(german.err, plain.err) << arguments[0];
  }
}

class Fit : public ProgramTest {};

TEST_F(Fit, IsThatOfIdentifyWithoutRankingAndCrossCheck) {
  const ProgramRun done = run({"fit", kFullTravel, "--json", "-"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const json report = json::parse(done.out);
  const json whole = json::parse(run({"identify", kFullTravel, "--no-trace", "--json", "-"}).out);
  EXPECT_EQ(report["final"]["parameters"], whole["final"]["parameters"]);
  EXPECT_TRUE(report["ranking"].empty());
  EXPECT_EQ(report["crosscheck"]["squareness"]["verdict"], "not_available");
}

TEST_F(Fit, PrintsText) {
  const ProgramRun done = run({"fit", kFullTravel});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("squareness Δβxz"));
  EXPECT_THAT(done.out, testing::Not(HasSubstr("Ranking")));
}

}  // namespace
}  // namespace slideway::identify_test
