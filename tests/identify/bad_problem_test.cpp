#include "identify/problem_file.hpp"

namespace slideway {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

TEST_F(ProblemFile, NamesLineKeyAndNearestKeyOfAMistypedOne) {
  EXPECT_THAT(profile_refusal("fede_mm_per_min = 2.0"),
              AllOf(HasSubstr(":9: profile.fede_mm_per_min: unknown key (did you mean "
                              "'feed_mm_per_min'?); accepted: name file"),
                    EndsWith("standard_uncertainty role")));
  EXPECT_THAT(refusal_behind("[low_bend]\nlevel = 1\n"),
              HasSubstr("low_bend: unknown key (did you mean 'low_band'?)"));
}

// Where the file is not there, that is what is said, once it is read.
TEST_F(ProblemFile, RefusesAMissingUnit) {
  const auto with = [&](const std::string& unit) {
    return refusal(std::string(kMachine) + "[[profile]]\nname = \"a\"\nfile = \"a.csv\"\n" + unit +
                   kEffect);
  };
  EXPECT_EQ(with("position_unit = \"mm\"\n"), "");
  std::ofstream(folder_.path() / "a.csv") << "0,1\n1,2\n";
  EXPECT_THAT(with("position_unit = \"mm\"\n"),
              EndsWith(":3: profile.value_unit: missing; accepted: m mm um nm inch"));
  EXPECT_THAT(with("value_unit = \"mm\"\n"),
              EndsWith(":3: profile.position_unit: missing; accepted: m mm um nm inch s"));
}

TEST_F(ProblemFile, RefusesAUnitOfTheWrongKind) {
  EXPECT_THAT(profile_refusal("quantity = \"slope\""),
              HasSubstr(":7: profile.value_unit: \"um\" is not accepted for a slope"));
}

TEST_F(ProblemFile, NeedsALeverAsSoonAsThereIsAFace) {
  EXPECT_THAT(refusal(profile() + kEffect),
              AllOf(HasSubstr("machine.lever: missing; a face needs it; accepted: \"paper\""),
                    HasSubstr("\"split\"")));
  EXPECT_EQ(refusal(profile("kind = \"slide\"") + kEffect), "");
}

TEST_F(ProblemFile, AllowsAnOverhangWithTheSplitLeverOnly) {
  EXPECT_THAT(profile_refusal("overhang_mm = 10.0"), HasSubstr("only with lever = \"split\""));
  EXPECT_EQ(profile_refusal("overhang_mm = 0.0"), "");
  EXPECT_THAT(refusal("[machine]\nlever = \"paper\"\noverhang_mm = 3.0\n" + profile() + kEffect),
              HasSubstr(":3: machine.overhang_mm: "));
}

TEST_F(ProblemFile, TakesTimeForAPositionOnlyWithAFeed) {
  const std::string timed =
      "[[profile]]\nname = \"a\"\nfile = \"a.csv\"\nposition_unit = \"s\"\nvalue_unit = \"um\"\n";
  EXPECT_THAT(refusal(kMachine + timed + kEffect), HasSubstr("profile.feed_mm_per_min: missing"));
  const Problem problem = read(kMachine + timed + "feed_mm_per_min = 2.0\n" + kEffect);
  EXPECT_EQ(problem.profiles[0].source.position_unit, "s");
}

TEST_F(ProblemFile, TakesALineByBothEnds) {
  EXPECT_THAT(profile_refusal("from_mm = [0, 0]"), HasSubstr(":3: profile.to_mm: missing"));
  EXPECT_THAT(profile_refusal("to_mm = [0, 0]"), HasSubstr(":3: profile.from_mm: missing"));
  for (const char* bad : {"[0]", "[0, nan]", "[0, \"a\"]", "7", "[2e9, 0]"})
    EXPECT_THAT(profile_refusal(std::string("to_mm = [0, 0]\nfrom_mm = ") + bad),
                HasSubstr(":10: profile.from_mm: must be a place [x, y]"))
        << bad;
  const Problem problem =
      read(kMachine + profile("from_mm = [0, 5.5]\nto_mm = [100, 5.5]") + kEffect);
  EXPECT_THAT(problem.profiles[0].profile.line->from_mm, ElementsAre(0.0, 5.5));
  EXPECT_THAT(problem.profiles[0].profile.line->to_mm, ElementsAre(100.0, 5.5));
}

TEST_F(ProblemFile, RefusesAnEffectTwiceInOneProfile) {
  const auto two = [&](const std::string& first, const std::string& second) {
    const std::string drift = "[[effect]]\nname = \"linear_drift\"\n";
    return refusal(kMachine + profile() + profile("", "b") + drift + first + drift + second);
  };
  const std::string in_a = "profiles = [\"feed2\"]\n", in_b = "profiles = [\"b\"]\n";
  EXPECT_EQ(two(in_a, in_b), "");
  for (const auto& [first, second] :
       {std::pair<std::string, std::string>{in_a, in_a}, {in_a, ""}, {"", in_b}, {"", ""}})
    EXPECT_THAT(two(first, second), HasSubstr("is declared twice")) << first << second;
}

TEST_F(ProblemFile, NeedsNoEffectForItsProfilesAlone) {
  const std::filesystem::path path = write(kMachine + profile());
  EXPECT_THROW(read_problem(path), UsageError);
  EXPECT_EQ(read_profiles_of_problem(path).profiles.size(), 1U);
}

TEST_F(ProblemFile, LeavesOutSpikesOrDataRows) {
  const std::string rule =
      "profile.leave_out: must be \"spikes\" or a list of data rows, the first one 1: [120, 121]";
  for (const char* bad : {"true", "12", "[0]", "[1.5]", "[\"spikes\"]", "[-1]"})
    EXPECT_THAT(profile_refusal(std::string("leave_out = ") + bad), HasSubstr(rule)) << bad;
  EXPECT_THAT(profile_refusal("leave_out = \"spike\""),
              HasSubstr("profile.leave_out: \"spike\" is not accepted (did you mean 'spikes'?); "
                        "accepted: spikes"));
  EXPECT_TRUE(read(kMachine + profile("leave_out = \"spikes\"") + kEffect)
                  .profiles[0]
                  .source.leave_out_spikes);
  EXPECT_THAT(
      read(kMachine + profile("leave_out = [120, 121]") + kEffect).profiles[0].source.left_out_rows,
      ElementsAre(120, 121));
}

TEST_F(ProblemFile, RefusesWordsThatAreNoDialect) {
  EXPECT_THAT(profile_refusal("delimiter = \"|\""),
              HasSubstr("profile.delimiter: \"|\" is not accepted; accepted: , ; tab blank"));
  EXPECT_THAT(profile_refusal("decimal = \";\""), HasSubstr("profile.decimal"));
  EXPECT_THAT(profile_refusal("encoding = \"utf8\""), HasSubstr("did you mean 'utf-8'?"));
  EXPECT_THAT(profile_refusal("header_lines = -1"), HasSubstr("profile.header_lines"));
  EXPECT_THAT(profile_refusal("line = 12"), HasSubstr("profile.line: must be a text"));
}

TEST_F(ProblemFile, RefusesWrongTypes) {
  EXPECT_THAT(profile_refusal("z_mm = \"2\""),
              HasSubstr(":9: profile.z_mm: must be a number, without quotes"));
  EXPECT_THAT(profile_refusal("z_mm = nan"), HasSubstr(":9: profile.z_mm: must be a finite"));
  EXPECT_THAT(profile_refusal("role = 1"), HasSubstr("profile.role: must be a text"));
  EXPECT_THAT(profile_refusal("free = \"offset\""), HasSubstr("profile.free: must be a list"));
  EXPECT_THAT(profile_refusal("start_s = 1979-05-27"), HasSubstr("must be a finite number"));
  EXPECT_THAT(profile_refusal("value_column = 0"), HasSubstr("whole number from 1"));
  EXPECT_THAT(refusal_behind("[low_band]\nlevel = 5.0\n"), HasSubstr("must be a whole number"));
  EXPECT_THAT(refusal("low_band = 5\n" + profile() + kEffect), HasSubstr("must be a table"));
  EXPECT_THAT(refusal("effect = 5\n" + (kMachine + profile())), HasSubstr("list of tables"));
}

TEST_F(ProblemFile, RefusesNumbersOutOfRange) {
  for (const char* line :
       {"feed_mm_per_min = 0.0", "feed_mm_per_min = -2", "spindle_rpm = 0", "cut_radius_mm = 0",
        "traverse_mm_per_s = -1.0", "standard_uncertainty = 0.0", "z_mm = nan", "z_mm = inf",
        "window = [1.0, 1.0]", "window = [2.0, 1.0]", "window = [1.0]", "window = [0.0, inf]"}) {
    EXPECT_THAT(profile_refusal(line), HasSubstr(":9: profile.")) << line;
  }
  EXPECT_THAT(profile_refusal("base_mm = 10.0"), HasSubstr("slope"));
  for (const char* lines :
       {"[low_band]\nlevel = -1", "[low_band]\nlevel = 31", "[low_band]\nwavelet = \"db20\"",
        "[low_band]\nboundary = \"mirror\"", "[trace]\nsignificance = 0.0",
        "[trace]\nsignificance = 1.0", "[truth]\nnoise_um = -1.0"}) {
    EXPECT_NE(refusal_behind(lines), "") << lines;
  }
}

TEST_F(ProblemFile, RefusesTheSameNameTwice) {
  EXPECT_THAT(refusal(kMachine + profile() + profile() + kEffect), HasSubstr("'feed2' is used"));
  EXPECT_THAT(refusal_behind(kEffect), HasSubstr("'squareness' is declared twice"));
  EXPECT_THAT(refusal_behind(std::string(kEffect) + "body = \"x_carriage\"\n"),
              HasSubstr("'squareness' is declared twice"));
}

TEST_F(ProblemFile, NeedsAProfileAndAnEffect) {
  EXPECT_THAT(refusal(std::string(kMachine) + kEffect), HasSubstr("at least one [[profile]]"));
  EXPECT_THAT(refusal(kMachine + profile()), HasSubstr("at least one [[effect]]"));
  EXPECT_NE(refusal(""), "");
}

TEST_F(ProblemFile, HoldsEffectsAgainstTheCatalogue) {
  EXPECT_THAT(refusal_behind("[[effect]]\nname = \"straightnes\"\n"),
              HasSubstr("did you mean 'straightness'?"));
  EXPECT_THAT(refusal_behind("[[effect]]\nname = \"straightness\"\n"), HasSubstr("degree"));
  EXPECT_THAT(refusal_behind("[[effect]]\nname = \"straightness\"\ndegree = -1\n"),
              HasSubstr("effect.degree"));
  EXPECT_THAT(
      refusal_behind("[[effect]]\nname = \"straightness\"\nbody = \"y_carriage\"\ndegree = 2\n"),
      HasSubstr("x_carriage"));
}

TEST_F(ProblemFile, HoldsPriorsAgainstTheParametersOfTheirEffect) {
  const std::string effect = "[[effect]]\nname = \"straightness\"\ndegree = 2\npriors = ";
  EXPECT_THAT(refusal_behind(effect +
                             "[{ parameter = \"b7\", value = 0.0, standard_uncertainty = 1.0 }]\n"),
              HasSubstr("effect.priors.parameter: \"b7\" is not accepted"));
  EXPECT_THAT(refusal_behind(effect +
                             "[{ parameter = \"b2\", value = 0.0, standard_uncertainty = 0.0 }]\n"),
              HasSubstr("effect.priors.standard_uncertainty"));
  EXPECT_THAT(refusal_behind(effect + "[{ parameter = \"b2\", value = 0.0 }]\n"),
              HasSubstr("missing"));
  std::string many;
  for (int i = 0; i < 101; ++i)
    many += "{ parameter = \"b2\", value = 0.0, standard_uncertainty = 1.0 }, ";
  EXPECT_THAT(refusal_behind(effect + "[" + many + "]\n"),
              HasSubstr("effect.priors: 101 priors; accepted: up to 100"));
}

TEST_F(ProblemFile, HoldsTheTruthAgainstTheModelAndTheCatalogue) {
  EXPECT_THAT(refusal_behind("[truth]\nparameters = { \"squareness.dbeta\" = 1e-6 }\n"),
              HasSubstr("truth.parameters.squareness.dbeta: unknown key"));
  const std::string hidden = "[[truth.effect]]\nname = \"thermal_drift\"\namplitude_um = 0.4\n";
  EXPECT_THAT(refusal_behind(hidden + "time_konstant_s = 9.0\n"),
              HasSubstr("did you mean 'time_constant_s'?"));
  EXPECT_THAT(refusal_behind(hidden + "time_constant_s = -9.0\n"), HasSubstr("out of range"));
}

TEST_F(ProblemFile, ChecksTheNamesOfTraceCandidates) {
  EXPECT_THAT(refusal_behind("[trace]\ncandidates = [\"thermal_drft\"]\n"),
              HasSubstr("did you mean 'thermal_drift'?"));
  const Problem problem =
      read(kMachine + profile() + kEffect + "[trace]\ncandidates = [\"cup\", \"step\"]\n");
  EXPECT_THAT(problem.trace.candidates, UnorderedElementsAre("cup", "step"));
}

TEST_F(ProblemFile, RefusesAMachineThatIsNoTree) {
  EXPECT_THAT(refusal("[machine]\nlever = \"paper\"\n[[machine.body]]\nname = \"x\"\nlower = 1\n"
                      "axis = \"x\"\n" +
                      profile() + kEffect),
              HasSubstr("machine.body: "));
}

TEST_F(ProblemFile, SaysInWhichLineItIsNoToml) {
  EXPECT_THAT(refusal("title = \"a\"\nlever = = 2\n"), HasSubstr(":2: no valid TOML: "));
  EXPECT_THAT(refusal("title = \"a\"\ntitle = \"b\"\n"), HasSubstr("no valid TOML: "));
}

TEST_F(ProblemFile, IsAUsageErrorWhenThereIsNoneOrADirectory) {
  EXPECT_THROW(read_problem(folder_.path() / "nothing.toml"), UsageError);
  EXPECT_THROW(read_problem(folder_.path()), UsageError);
}

}  // namespace
}  // namespace slideway
