#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"

namespace slideway::plan_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string kProblem = R"(title = "Two cuts"
[machine]
lever = "paper"
[low_band]
level = 3
[[profile]]
name = "slow"
file = "slow.csv"
position_unit = "mm"
value_unit = "um"
cut_radius_mm = 50.0
feed_mm_per_min = 2.0
spindle_rpm = 110.0
cut_direction = "inward"
free = ["offset"]
[[effect]]
name = "squareness"
[trace]
candidates = ["linear_drift", "cup"]
[[plan.cut]]
name = "fast"
feed_mm_per_min = 8.0
time_min = 6.25
cost = 40.0
[[plan.cut]]
name = "once_more"
)";
const std::string kTruth = R"([truth]
noise_um = 0.01
samples = 2000
parameters = { "squareness.dbeta_xz" = 2.8e-6 }
)";

class PlanCommandTest : public ProgramTest {
 protected:
  PlanCommandTest() {
    folder_.file("truth.toml", kProblem + kTruth);
    EXPECT_EQ(run({"simulate", "truth.toml", "--out", "."}).exit_code, 0);
  }
};

TEST_F(PlanCommandTest, RanksTheCutsOfTheProblem) {
  const ProgramRun done = run({"plan", "problem.toml"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, AllOf(HasSubstr("Next: a cut at 8 mm/min (fast)\n"),
                              HasSubstr("shows steady drift (from "), HasSubstr("cost 40"),
                              HasSubstr("6.25 min"), HasSubstr("\n  2  once_more: ")));
}

TEST_F(PlanCommandTest, WritesJsonAndPage) {
  const ProgramRun done = run({"plan", "problem.toml", "--json", "-", "--html", "plan.html"});
  const auto plan = nlohmann::json::parse(done.out);
  EXPECT_EQ(plan["schema"], "slideway.plan/1");
  EXPECT_EQ(plan["alone"][0]["cuts"][0], "fast");
  EXPECT_EQ(plan["cuts"].size(), 2U);
  EXPECT_EQ(plan["sets"][0]["cuts"].size(), 2U);
  EXPECT_THAT(contents(path("plan.html")), AllOf(HasSubstr("<svg"), HasSubstr("fast")));
}

// When a cut began is not known before; beside a log a wrong time would be a wrong cause.
TEST_F(PlanCommandTest, AsksForTheStartOfANewCutBesideALog) {
  std::string log = "t_s,T_degC\n";
  for (int t = 0; t <= 1600; t += 10) log += std::to_string(t) + ",20.0\n";
  folder_.file("log.csv", log);
  std::string text = contents(path("problem.toml"));
  text +=
      "[[channel]]\nname = \"temperature\"\nfile = \"log.csv\"\ntime_column = \"t_s\"\n"
      "time_unit = \"s\"\nvalue_column = \"T_degC\"\n";
  folder_.file("with-log.toml", text);
  ASSERT_EQ(run({"plan", "with-log.toml", "--out", "next", "--quiet"}).exit_code, 0);
  EXPECT_THAT(contents(path("next/1-cut.toml")), HasSubstr("start_s = nan  # fill in"));
  const ProgramRun done = run({"identify", "next/1-cut.toml"});
  EXPECT_EQ(done.exit_code, 2);
  EXPECT_THAT(done.err, HasSubstr("profile.start_s: must be a finite number"));
}

// A problem that is ready but for the data: with them it runs.
TEST_F(PlanCommandTest, WritesProblemFilesForTheNewCuts) {
  EXPECT_EQ(run({"plan", "problem.toml", "--out", "next", "--quiet"}).exit_code, 0);
  EXPECT_THAT(names_in(path("next")), testing::ElementsAre("1-cut.toml", "2-cuts.toml"));
  const std::string text = contents(path("next/1-cut.toml"));
  EXPECT_THAT(text, AllOf(HasSubstr("# To be measured: a cut at 8 mm/min, all else as slow.\n"),
                          HasSubstr("name = \"fast\"\nfile = \"fast.csv\"\n"),
                          HasSubstr("feed_mm_per_min = 8.0\n"), testing::Not(HasSubstr("plan"))));
  const ProgramRun unmeasured = run({"identify", "next/1-cut.toml", "--no-trace"});
  EXPECT_TRUE(is_refused(unmeasured, 3));
  EXPECT_THAT(unmeasured.err, HasSubstr("fast.csv"));
  std::filesystem::copy_file(path("slow.csv"), path("next/fast.csv"));
  EXPECT_EQ(run({"identify", "next/1-cut.toml", "--no-trace"}).exit_code, 0);
}

TEST_F(PlanCommandTest, NeedsMeasuredProfiles) {
  std::filesystem::remove(path("slow.csv"));
  const ProgramRun refused = run({"plan", "truth.toml"});
  EXPECT_TRUE(is_refused(refused, 2));
  EXPECT_THAT(refused.err, AllOf(HasSubstr("plan needs measured profiles"),
                                 HasSubstr("slideway simulate truth.toml")));
}

}  // namespace
}  // namespace slideway::plan_test
