#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/run_program.hpp"
#include "slideway/report/layout.hpp"

namespace slideway::effects_test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

// Name and independent variable of every effect of the interface.
const std::map<std::string, std::string> kEffects{{"straightness", "x"},
                                                  {"vertical_straightness", "r"},
                                                  {"squareness", "r"},
                                                  {"linear_drift", "t"},
                                                  {"thermal_drift", "t"},
                                                  {"time_periodic", "t"},
                                                  {"tool_wear", "s"},
                                                  {"tool_running_in", "s"},
                                                  {"slide_periodic", "x"},
                                                  {"gantry_sag", "x"},
                                                  {"revolution_periodic", "k"},
                                                  {"spindle_runout", "k"},
                                                  {"feed_marks", "k"},
                                                  {"step", "r"},
                                                  {"centre_height", "r"},
                                                  {"speed_effect", "r"},
                                                  {"edge_roll_off", "r"},
                                                  {"cup", "r"},
                                                  {"traverse_datum", "X"},
                                                  {"centre_step", "X"},
                                                  {"traverse_periodic", "m"},
                                                  {"chucking_lobes", "r"},
                                                  {"local_form", "x"},
                                                  {"centring", "X"},
                                                  {"chord", "r"},
                                                  {"hysteresis", "x"},
                                                  {"zero_drift", "t_read"},
                                                  {"instrument_zero", "X"},
                                                  {"artefact_form", "x"}};

class Effects : public ProgramTest {};

TEST_F(Effects, ListsEveryEffectOfTheInterfaceWithItsVariable) {
  const ProgramRun done = run({"effects", "--json", "-"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  std::map<std::string, std::string> listed;
  const json document = json::parse(done.out);
  for (const json& effect : document["effects"]) listed[effect["name"]] = effect["clock"];
  EXPECT_EQ(listed, kEffects);
}

TEST_F(Effects, PrintsEveryEffectWithin80Columns) {
  const ProgramRun done = run({"effects"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.err, "");
  for (const auto& [name, variable] : kEffects)
    EXPECT_THAT("\n" + done.out, HasSubstr("\n" + name + "\n  variable " + variable + " "));
  for (const std::string& line : lines_of(done.out)) EXPECT_LE(code_points(line), 80U) << line;
}

TEST_F(Effects, PrintsOneEntryInFull) {
  for (const auto& [name, variable] : kEffects) {
    const ProgramRun done = run({"effects", name});
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_THAT(done.out, testing::StartsWith(name + "\n"));
    for (const char* label :
         {"formula:", "variable:", "parameters:", "confounded with:", "separated by:"})
      EXPECT_THAT(done.out, HasSubstr(std::string("\n  ") + label)) << name;
    for (const std::string& line : lines_of(done.out)) EXPECT_LE(code_points(line), 80U) << line;
  }
}

TEST_F(Effects, GivesOneEntryAsJson) {
  const ProgramRun done = run({"effects", "thermal_drift", "--quiet", "--json", "entry.json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, "");
  const json effects = json::parse(contents(path("entry.json")))["effects"];
  ASSERT_EQ(effects.size(), 1U);
  std::vector<std::string> parameters;
  for (const json& parameter : effects[0]["parameters"]) parameters.push_back(parameter["name"]);
  EXPECT_THAT(parameters, testing::ElementsAre("amplitude_um", "time_constant_s"));
}

const std::string kOwn = R"toml([[effect]]
name = "formula"
as = "coolant"
formula = "a * (1 - exp(-max(t - t0, 0) / tau))"
parameters = [{ name = "a", unit = "um" }, { name = "t0", unit = "s", lower = 0, upper = 300 },
  { name = "tau", unit = "s", lower = 1, upper = 600 }]
cause = "coolant switched on"
source = "trials"
typical = "0.2 to 1 um"
)toml";

TEST_F(Effects, OfAFileAreCheckedAndPrintedWithCauseSourceAndSize) {
  folder_.file("our-lathes.toml", kOwn);
  const ProgramRun done = run({"effects", "our-lathes.toml"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out, testing::StartsWith("coolant\n"));
  for (const char* text :
       {"coolant switched on", "trials", "0.2 to 1 um", "a (µm), t0 (s), tau (s)"})
    EXPECT_THAT(done.out, HasSubstr(text));
}

TEST_F(Effects, OfAFileThatBreakTheContractAreRefused) {
  std::string pole = kOwn;
  pole.replace(pole.find("max(t - t0, 0)"), 14, "1 / (t - t0)");
  folder_.file("our-lathes.toml", pole);
  const ProgramRun refused = run({"effects", "our-lathes.toml"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, testing::AllOf(HasSubstr("our-lathes.toml: coolant: on a face"),
                                          HasSubstr("of its formula")));
  EXPECT_EQ(run({"effects", "none.toml"}).exit_code, 2);
}

// A line of slope 1 in r that time makes and a cone makes: on one cut the two are one column.
TEST_F(Effects, OfAProblemSayWhatItsProfilesCannotTellApart) {
  std::string face = "x_mm,z_um\n";
  for (int i = 0; i < 400; ++i)
    face += std::to_string(0.025 * i) + "," + std::to_string((i * 37 % 11) * 0.001) + "\n";
  folder_.file("face.csv", face);
  folder_.file("problem.toml", R"([machine]
lever = "paper"
[[profile]]
name = "one"
file = "face.csv"
position_unit = "mm"
value_unit = "um"
feed_mm_per_min = 2
cut_direction = "inward"
free = ["offset"]
[[effect]]
name = "squareness"
[[trace.candidate]]
name = "formula"
as = "rise"
formula = "a * t"
parameters = [{ name = "a", unit = "um/s" }]
)");
  const ProgramRun done = run({"effects", "--problem", "problem.toml", "--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const json effects = json::parse(done.out)["effects"];
  EXPECT_EQ(effects.size(), kEffects.size() + 1);
  std::map<std::string, double> shares;
  for (const json& each : effects.back()["design"]["lookalikes"])
    shares[each["effect"]] = each["share"];
  EXPECT_NEAR(shares["squareness"], 1.0, 1e-6);
  EXPECT_NEAR(shares["linear_drift"], 1.0, 1e-6);
  EXPECT_THAT(run({"effects", "rise", "--problem", "problem.toml"}).out,
              HasSubstr("here looks like:"));
}

}  // namespace
}  // namespace slideway::effects_test
