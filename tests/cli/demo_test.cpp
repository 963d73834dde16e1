#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/run_program.hpp"
#include "slideway/base/file.hpp"

namespace slideway::demo_test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

class Demo : public ProgramTest {};

TEST_F(Demo, EndsWithAVerdictAndAPageWhoseNumbersMeanSomething) {
  const ProgramRun demo = run({"demo"});
  ASSERT_EQ(demo.exit_code, 0) << demo.err;
  EXPECT_THAT(demo.out, AllOf(HasSubstr("Explained"), HasSubstr("slideway-demo/report.html"),
                              HasSubstr("slideway init")));
  EXPECT_TRUE(contents(path("slideway-demo/report.html")).starts_with("<!DOCTYPE html>"));
  const json report = json::parse(contents(path("slideway-demo/result.json")));
  EXPECT_EQ(report["trace"]["verdict"], "explained");
  for (const json& p : report["final"]["parameters"]) {
    if (!p["identifiable"].get<bool>()) continue;
    EXPECT_GT(std::abs(p["value"].get<double>()), p["expanded_uncertainty"].get<double>())
        << p["name"];
  }
  // What the script that made the example has put in: bench/workshop/demo.py.
  for (const json& p : report["final"]["parameters"])
    if (p["name"] == "squareness.dbeta_xz") {
      EXPECT_NEAR(p["value"].get<double>(), 12e-6, p["expanded_uncertainty"].get<double>());
    }
  const std::string before = contents(path("slideway-demo/result.json"));
  EXPECT_EQ(run({"demo"}).exit_code, 0);
  EXPECT_EQ(contents(path("slideway-demo/result.json")), before);
}

TEST_F(Demo, LeavesOtherFilesAlone) {
  std::filesystem::create_directory(path("slideway-demo"));
  write_file(path("slideway-demo/problem.toml"), "mine");
  EXPECT_TRUE(is_refused(run({"demo"}), 2));
  EXPECT_EQ(contents(path("slideway-demo/problem.toml")), "mine");
}

TEST_F(Demo, NameAloneSaysWhatToTypeFirst) {
  const ProgramRun alone = run({});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_THAT(alone.err, AllOf(HasSubstr("slideway demo"), HasSubstr("slideway init FILE")));
  EXPECT_LE(lines_of(alone.err).size(), 12U);
}

TEST_F(Demo, ADataFileIsNoProblem) {
  for (const char* name : {"plan.csv", "my plan.csv"})
    write_file(path(name), "x_mm,z_um\n0,1\n1,2\n");
  EXPECT_THAT(run({"identify", "my plan.csv"}).err, HasSubstr("slideway init 'my plan.csv'"));
  for (const char* command : {"identify", "fit", "check"}) {
    const ProgramRun refused = run({command, "plan.csv"});
    EXPECT_TRUE(is_refused(refused, 2));
    EXPECT_THAT(refused.err, HasSubstr("slideway init plan.csv"));
  }
}

}  // namespace
}  // namespace slideway::demo_test
