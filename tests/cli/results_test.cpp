// What is done with a result afterwards: diff, export.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/run_program.hpp"
#include "slideway/base/file.hpp"

namespace slideway::results_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Results : public ProgramTest {
 protected:
  void SetUp() override {
    const ProgramRun done = run({"identify", "--no-trace", "--quiet", "--json", "way.json",
                                 shipped("problems/milling-machine-way/problem.toml")});
    ASSERT_EQ(done.exit_code, 0) << done.err;
  }
};

TEST_F(Results, ExportWritesStraightnessOverTheMeasuredTravel) {
  const ProgramRun done = run({"export", "way.json", "--to", "isg", "--step", "100"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.err, HasSubstr("B0X is left out: the model has no squareness"));
  const std::vector<std::string> lines = lines_of(done.out);
  const json in = json::parse(contents(path("way.json")))["inputs"][0];
  // The travel ends at the far foot of the bridge; its base is 103.1324 mm.
  EXPECT_NEAR(std::stod(lines.back()), in["position_max_mm"].get<double>() + 0.5 * 103.1324, 1e-6);
  EXPECT_THAT(lines.back(), HasSubstr("\t0.000000000000"));
  EXPECT_THAT(done.out, HasSubstr("\nX\tEZX\n"));
  EXPECT_THAT(done.out, HasSubstr("// Values are errors"));
}

TEST_F(Results, ExportWritesACalibrationCertificateOnceItsFactsAreThere) {
  const ProgramRun bare = run({"export", "way.json", "--to", "dcc"});
  EXPECT_TRUE(is_refused(bare, 3));
  EXPECT_THAT(bare.err, HasSubstr("[about] lacks certificate, country, date, "));
  json report = json::parse(contents(path("way.json")));
  for (const char* key : {"certificate", "machine", "serial", "manufacturer", "responsible"})
    report["about"][key] = "given";
  report["about"].update({{"country", "DE"},
                          {"date", "2026-11-23"},
                          {"laboratory", "Test room, Aachen"},
                          {"customer", "Turned Parts, Bonn"}});
  write_file(path("whole.json"), report.dump());
  const ProgramRun done = run({"export", "whole.json", "--to", "dcc", "--out", "way.xml"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(contents(path("way.xml")), HasSubstr("<si:unit>\\micro\\metre</si:unit>"));
  EXPECT_TRUE(is_refused(run({"export", "whole.json", "--to", "dcc", "--step", "1"}), 2));
}

TEST_F(Results, ExportWritesFilesAndKeepsItsInput) {
  EXPECT_EQ(run({"export", "way.json", "--to", "cec", "--out", "way.ini", "-q"}).err, "");
  EXPECT_THAT(contents(path("way.ini")), testing::StartsWith("%_N_NC_CEC_INI\nCHANDATA(1)\n; "));
  EXPECT_TRUE(is_refused(run({"export", "way.json", "--to", "cec", "--out", "way.json"}), 2));
}

TEST_F(Results, ExportSaysOnStderrWhatATableWithoutCommentsCanNot) {
  const ProgramRun done = run({"export", "way.json", "--to", "heidenhain"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const std::vector<std::string> lines = lines_of(done.out);
  EXPECT_EQ(lines.front(), "BEGIN SLIDEWAY.COM MM");
  EXPECT_EQ(lines.back(), "[END]");
  EXPECT_EQ(lines.size(), 54U);  // fifty pieces of the travel
  EXPECT_THAT(done.err, HasSubstr("slideway: Values are errors: actual minus nominal"));
  EXPECT_THAT(done.err, HasSubstr("second face"));
  EXPECT_THAT(done.err, HasSubstr("B0X is left out: the model has no squareness"));
}

TEST_F(Results, ExportRefusesInOneLine) {
  EXPECT_TRUE(is_refused(run({"export", "way.json"}), 2));
  EXPECT_TRUE(
      is_refused(run({"export", "way.json", "--to", "heidenhain", "--step", "0.5", "-q"}), 2));
  EXPECT_TRUE(is_refused(run({"export", "way.json", "--to", "isg", "--step", "0"}), 2));
  EXPECT_TRUE(is_refused(run({"export", "way.json", "--to", "isg", "--step", "1e-9"}), 2));
  EXPECT_THAT(run({"export", "way.json", "--to", "etalno"}).err,
              HasSubstr("did you mean 'etalon'?"));
  EXPECT_TRUE(is_refused(run({"export", shipped("README.md"), "--to", "isg"}), 3));
  EXPECT_TRUE(is_refused(run({"export", "none.json", "--to", "isg"}), 3));
  ASSERT_EQ(run({"rank", shipped("problems/milling-machine-way/problem.toml"), "-q", "--json",
                 "rank.json"})
                .exit_code,
            0);
  EXPECT_TRUE(is_refused(run({"export", "rank.json", "--to", "isg"}), 3));
}

TEST_F(Results, DiffOfOneResultWithItselfIsNothing) {
  const ProgramRun done = run({"diff", "way.json", "way.json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("Inputs, options and verdicts are the same."));
  const json document = json::parse(run({"diff", "way.json", "way.json", "--json", "-"}).out);
  EXPECT_EQ(document["schema"], "slideway.diff/1");
  EXPECT_TRUE(document["changes"].empty());
}

TEST_F(Results, DiffRefusesInOneLine) {
  EXPECT_TRUE(is_refused(run({"diff", "way.json"}), 2));
  EXPECT_TRUE(is_refused(run({"diff", "way.json", "way.json", "--json", "way.json"}), 2));
  write_file(path("cut.json"), contents(path("way.json")).substr(0, 2000));
  EXPECT_TRUE(is_refused(run({"diff", "way.json", "cut.json"}), 3));
}

}  // namespace
}  // namespace slideway::results_test
