#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/run_program.hpp"
#include "slideway/report/layout.hpp"

namespace slideway {
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
                                                  {"hysteresis", "x"}};

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

}  // namespace
}  // namespace slideway
