#include "cli/bad_input.hpp"

namespace slideway {
namespace {

class BadProblem : public BadInputTest {};

TEST_P(BadProblem, IsRefusedInOneLine) { expect_refused(); }

// The parts in order: machine, low_band, file, columns, units, profile_more, effect, more.
BadInput bad(const std::string& name, const ProblemText& problem,
             const std::vector<std::string>& fragments) {
  return {name, problem.text(), face_csv(64), 2, fragments};
}

BadInput bad_text(const std::string& name, const std::string& text,
                  const std::vector<std::string>& fragments) {
  return {name, text, face_csv(64), 2, fragments};
}

// Of a file that does not state them.
BadInput bad_units(const std::string& name, const std::string& units,
                   const std::vector<std::string>& fragments) {
  return {name, ProblemText{.columns = "", .units = units}.text(), "x,z\n0,1\n1,2\n2,1\n", 2,
          fragments};
}

std::string body(const std::string& name, int lower) {
  return "[[machine.body]]\nname = \"" + name + "\"\nlower = " + std::to_string(lower) +
         "\naxis = \"" + name.substr(0, 1) + "\"\n";
}

const std::string kGood = ProblemText{}.text();
const std::string kPaper = ProblemText{}.machine;

const BadInput kKeys[] = {
    bad("UnknownKey", {.profile_more = "feed_mm_pr_min = 2\n"},
        {"problem.toml:12: profile.feed_mm_pr_min: unknown key", "did you mean 'feed_mm_per_min'?",
         "accepted: name file kind"}),
    bad_text("UnknownKeyOfTheFile", "titel = \"x\"\n" + kGood,
             {"problem.toml:1: titel: unknown key", "did you mean 'title'?", "accepted: title"}),
    bad_units("PositionUnitMissing", "value_unit = \"um\"\n",
              {"problem.toml:5: profile.position_unit: missing", "accepted: m mm um nm inch s"}),
    bad_units("ValueUnitMissing", "position_unit = \"mm\"\n",
              {"problem.toml:5: profile.value_unit: missing", "accepted: m mm um nm inch"}),
    bad("UnitThatIsNone", {.units = "position_unit = \"mm\"\nvalue_unit = \"micron\"\n"},
        {"problem.toml:11: profile.value_unit", "\"micron\"", "accepted: m mm um nm inch"}),
    bad("UnitOfASlopeForAHeight", {.units = "position_unit = \"mm\"\nvalue_unit = \"arcsec\"\n"},
        {"problem.toml:11: profile.value_unit", "not accepted for a height", "accepted: m mm um"}),
    bad("TextForANumber", {.profile_more = "feed_mm_per_min = \"fast\"\n"},
        {"problem.toml:12: profile.feed_mm_per_min: must be a number, without quotes"}),
    bad("NumberForAText", {.low_band = "[low_band]\nwavelet = 4\n"},
        {"problem.toml:4: low_band.wavelet: must be a text"}),
    bad("TextForAWholeNumber", {.low_band = "[low_band]\nlevel = \"5\"\n"},
        {"problem.toml:4: low_band.level: must be a whole number from 0 to 30"}),
    bad("NanForANumber", {.profile_more = "center_mm = nan\n"},
        {"problem.toml:12: profile.center_mm: must be a finite number"}),
    bad("TableForAListOfTables", {.more = "[trace]\ncandidates = { a = 1 }\n"},
        {"problem.toml:15: trace.candidates: must be a list of texts", "accepted: straightness"}),
    bad("TimeLimitThatIsOver", {.more = "[trace]\ntime_limit_s = 0\n"},
        {"problem.toml:15: trace.time_limit_s: must be greater than 0, not 0"}),
    bad("NegativeFeed", {.profile_more = "feed_mm_per_min = -2\n"},
        {"problem.toml:12: profile.feed_mm_per_min: must be greater than 0, not -2"}),
    bad("WindowUpsideDown", {.profile_more = "window = [10.0, 2.0]\n"},
        {"problem.toml:12: profile.window: must be two finite numbers, the smaller one first"}),
    bad("LineWithOneEnd", {.profile_more = "from_mm = [0, 0]\n"},
        {"problem.toml:5: profile.to_mm: missing", "accepted: [x, y] of both ends"}),
    bad("LineWithoutLength", {.profile_more = "from_mm = [0, 5]\nto_mm = [0, 5]\n"},
        {"problem.toml:13: profile.to_mm: is from_mm", "accepted: the other end"}),
    bad("PlaceOfThreeNumbers", {.profile_more = "from_mm = [0, 0, 0]\nto_mm = [1, 0]\n"},
        {"problem.toml:12: profile.from_mm: must be a place [x, y]"}),
    bad("LevelOutOfRange", {.low_band = "[low_band]\nlevel = 31\n"},
        {"problem.toml:4: low_band.level", "from 0 to 30, not 31"}),
};
INSTANTIATE_TEST_SUITE_P(BadKey, BadProblem, testing::ValuesIn(kKeys),
                         [](const auto& input) { return input.param.name; });

const BadInput kNames[] = {
    bad("UnknownEffect", {.effect = "[[effect]]\nname = \"squarness\"\n"},
        {"problem.toml:13: effect.name", "\"squarness\"", "did you mean 'squareness'?",
         "accepted: straightness vertical_straightness"}),
    bad("UnknownWavelet", {.low_band = "[low_band]\nwavelet = \"haar\"\n"},
        {"problem.toml:4: low_band.wavelet", "\"haar\"", "accepted: db1 db2"}),
    bad("UnknownBoundary", {.low_band = "[low_band]\nboundary = \"symetric\"\n"},
        {"problem.toml:4: low_band.boundary", "did you mean 'symmetric'?", "accepted: zero"}),
    bad("UnknownBody",
        {.effect = "[[effect]]\nname = \"straightness\"\nbody = \"y_carriage\"\ndegree = 3\n"},
        {"problem.toml:12: effect", "no body 'y_carriage'", "x_carriage, z_carriage"}),
    bad("UnknownParameterOfAPrior",
        {.more = "priors = [{ parameter = \"b2\", value = 0, standard_uncertainty = 1 }]\n"},
        {"problem.toml:14: effect.priors.parameter", "\"b2\"", "accepted: dbeta_xz"}),
    bad("UnknownVariableInAPath", {.file = "${HOME}/face.csv"},
        {"problem.toml:7: profile.file: unknown variable", "accepted: ${SLIDEWAY_DATA}"}),
    bad("DataDirectoryNotSet", {.file = "${SLIDEWAY_DATA}/face.csv"},
        {"problem.toml:7: profile.file", "which is not set", "accepted: --data DIR"}),
    bad("ProfileNameUsedTwice", {.effect = ProblemText{.machine = "", .low_band = ""}.text()},
        {"problem.toml:13: profile.name: 'face' is used twice", "accepted: a name of its own"}),
};
INSTANTIATE_TEST_SUITE_P(BadName, BadProblem, testing::ValuesIn(kNames),
                         [](const auto& input) { return input.param.name; });

const BadInput kWholes[] = {
    bad("LeverMissingWithAFace", {.machine = ""},
        {"problem.toml: machine.lever: missing; a face needs it", "accepted: \"paper\"",
         "\"split\""}),
    bad("LeverMissingInTheMachine", {.machine = "[machine]\nspindle_position_mm = 1.0\n"},
        {"problem.toml:1: machine.lever: missing", "accepted: \"paper\""}),
    bad("RowToLeaveOutThatIsNotThere", {.profile_more = "leave_out = [99999]\n"},
        {"profile 'face': leave_out: data row 99999 is not there", "accepted: 1 to "}),
    bad("OverhangOfThePaper", {.profile_more = "overhang_mm = 2.0\n"},
        {"problem.toml:12: profile.overhang_mm", "accepted: only with lever = \"split\""}),
    bad("CycleInBodies", {.machine = kPaper + body("x_carriage", 2) + body("z_carriage", 1)},
        {"problem.toml:3: machine.body", "is a cycle", "must end at body 0"}),
    bad("LowerBodyThatIsNotThere", {.machine = kPaper + body("x_carriage", 7)},
        {"problem.toml:3: machine.body", "lower = 7", "accepted: 0 (the bed) to 1"}),
    bad("DegreeMissing", {.effect = "[[effect]]\nname = \"straightness\"\n"},
        {"problem.toml:12: effect", "'degree' is missing", "accepted: 0 to"}),
    bad("NoEffect", {.effect = ""}, {"problem.toml: effect: missing", "at least one [[effect]]"}),
    bad_text("NoProfile", kPaper + ProblemText{}.effect,
             {"problem.toml: profile: missing", "at least one [[profile]]"}),
    bad("NothingToFit", {.profile_more = "role = \"holdout\"\n"},
        {"problem.toml: no profile has role = \"fit\""}),
    bad("MetadataMissing", {.effect = "[[effect]]\nname = \"thermal_drift\"\n"},
        {"problem.toml: effect 'thermal_drift' needs feed_mm_per_min", "of profile 'face'"}),
    bad("TraceBeyondTheCut", {.profile_more = "cut_radius_mm = 1.0\n"},
        {"problem.toml:12: profile.cut_radius_mm: 'face': 1, but", "r = 63",
         "give the outer radius"}),
};
INSTANTIATE_TEST_SUITE_P(BadWhole, BadProblem, testing::ValuesIn(kWholes),
                         [](const auto& input) { return input.param.name; });

const BadInput kSyntax[] = {
    bad("ValueMissing", {.more = "degree = = 2\n"}, {"problem.toml:14: no valid TOML"}),
    bad("BracketMissing", {.more = "[runout\n"}, {"problem.toml:14: no valid TOML"}),
    bad("KeyTwice", {.profile_more = "name = \"b\"\n"}, {"problem.toml:12: no valid TOML", "name"}),
    bad("TableTwice", {.more = "[machine]\n"}, {"problem.toml:14: no valid TOML", "machine"}),
    bad_text("QuoteMissing", "title = \"abc\n" + kGood, {"problem.toml:1: no valid TOML"}),
    bad_text("InvalidUtf8", "title = \"\xff\xfe\"\n" + kGood,
             {"problem.toml:1: no valid TOML", "utf-8"}),
    bad_text("Binary", std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16),
             {"problem.toml:1: no valid TOML"}),
    bad_text("Zeros", std::string(64, '\0'), {"problem.toml:1: no valid TOML"}),
    bad_text("Nested", "a = " + std::string(5000, '[') + "\n", {"problem.toml:1: no valid TOML"}),
    bad_text("Empty", "", {"problem.toml: profile: missing", "at least one [[profile]]"}),
};
INSTANTIATE_TEST_SUITE_P(BadSyntax, BadProblem, testing::ValuesIn(kSyntax),
                         [](const auto& input) { return input.param.name; });

class ProblemPath : public ProgramTest {};

TEST_F(ProblemPath, ToNothingIsRefused) {
  const ProgramRun refused = run({"identify", "gone.toml", "--json", "report.json"});
  EXPECT_TRUE(is_refused(refused, 2));
  EXPECT_THAT(refused.err, testing::StartsWith("slideway: gone.toml: cannot be read"));
  EXPECT_THAT(names_in(folder_.path()), testing::IsEmpty());
}

TEST_F(ProblemPath, ToADirectoryIsRefused) {
  const ProgramRun refused = run({"identify", "."});
  EXPECT_TRUE(is_refused(refused, 2));
  EXPECT_EQ(refused.err, "slideway: .: is a directory, expected a file\n");
}

TEST_F(ProblemPath, IsWhatPathsInTheProblemAreRelativeTo) {
  std::filesystem::create_directories(path("there"));
  folder_.file("there/problem.toml", kGood);
  folder_.file("there/face.csv", face_csv(64));
  const ProgramRun done = run({"identify", "there/problem.toml"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
}

TEST_F(ProblemPath, TakesTheDataDirectoryFromOptionBeforeVariable) {
  folder_.file("problem.toml", ProblemText{.file = "${SLIDEWAY_DATA}/face.csv"}.text());
  std::filesystem::create_directories(path("data"));
  folder_.file("data/face.csv", face_csv(64));
  const auto run_with = [&](const std::string& variable, std::vector<std::string> more) {
    more.insert(more.begin(), {"identify", "problem.toml"});
    return run_program(more, {folder_.path(), {}, {{"SLIDEWAY_DATA", variable}}}).exit_code;
  };
  EXPECT_EQ(run_with("data", {}), 0);
  EXPECT_EQ(run_with("elsewhere", {"--data", "data"}), 0);
  EXPECT_EQ(run_with("elsewhere", {}), 3);
}

}  // namespace

std::vector<BadInputs> bad_problems() {
  return {{"BadKey/BadProblem", kKeys},
          {"BadName/BadProblem", kNames},
          {"BadWhole/BadProblem", kWholes},
          {"BadSyntax/BadProblem", kSyntax}};
}

}  // namespace slideway
