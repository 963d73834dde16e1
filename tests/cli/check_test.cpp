#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/layout.hpp"

namespace slideway::check_test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

class Check : public ProgramTest {
 protected:
  ProgramRun check(const std::string& problem, const std::string& csv = face_csv(64)) {
    write_file(path("face.csv"), csv);
    write_file(path("problem.toml"), problem);
    return run({"check", "problem.toml"});
  }
};

TEST_F(Check, NamesEveryFaultWithItsLineAndAMark) {
  const ProgramRun found = check(ProblemText{.machine = "[machine]\noverhang_mm = 3\n",
                                             .units = "position_unit = \"mm\"\n"
                                                      "value_unit = \"mum\"\n",
                                             .profile_more = "feed_mm_pr_min = 2\nz_mm = \"a\"\n",
                                             .effect = "[[effect]]\nname = \"squarenes\"\n"}
                                     .text());
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_EQ(found.err, "");
  for (const char* part :
       {"machine.overhang_mm: has no meaning here", "machine.lever: missing",
        "profile.feed_mm_pr_min: unknown key", "  12 | feed_mm_pr_min = 2\n     | ^^^^^^^^^^^^^^\n",
        "  11 | value_unit = \"mum\"\n     |              ^^^^^\n", "profile.z_mm: must be a",
        "effect.name: \"squarenes\"", "6 faults"})
    EXPECT_THAT(found.out, HasSubstr(part));
}

TEST_F(Check, OneFaultHidesNoOther) {
  const std::string profile =
      "[[profile]]\nname = \"gone\"\nfile = \"gone.csv\"\nposition_column = \"x_mm\"\n"
      "value_column = \"z_um\"\nposition_unit = \"mm\"\nvalue_unit = \"um\"\n";
  const ProgramRun found =
      check(ProblemText{.columns = "position_column = \"q\"\nvalue_column = \"z_um\"\n",
                        .effect = profile + "[[effect]]\nname = \"straightness\"\ndegree = 3\n"
                                            "body = \"y\"\n[[effect]]\nname = \"channel\"\n"
                                            "channel = \"oil\"\n",
                        .more = "[[channel]]\nname = \"oil\"\nfile = \"oil.csv\"\n"
                                "time_column = \"t\"\nvalue_column = \"T\"\ntime_unit = \"s\"\n"}
                .text());
  EXPECT_EQ(found.exit_code, 2);
  for (const char* part :
       {"no column 'q'", "profile 'gone': gone.csv: cannot be read", "no body 'y'",
        "channel 'oil': oil.csv: cannot be read", "| file = \"oil.csv\"", "4 faults"})
    EXPECT_THAT(found.out, HasSubstr(part));
}

TEST_F(Check, NeverOffersAUnitOfAnotherSize) {
  for (const char* unit : {"mum", "micron", "mm ", "nmm", "km", "MM"}) {
    const std::string said =
        check(ProblemText{.units = std::string("position_unit = \"mm\"\nvalue_unit = \"") + unit +
                                   "\"\n"}
                  .text())
            .out;
    EXPECT_THAT(said, Not(HasSubstr("mean 'mm'"))) << unit;
    EXPECT_THAT(said, Not(HasSubstr("mean 'nm'"))) << unit;
  }
  EXPECT_THAT(
      check(ProblemText{.units = "position_unit = \"mm\"\nvalue_unit = \"mum\"\n"}.text()).out,
      HasSubstr("mean 'um'?"));
}

TEST_F(Check, ListsTheColumnsOfTheHeaderWhereOneIsMissing) {
  const std::string csv =
      "Protokoll;\nMaschine;LT-3\nDatum;12.03.2026\nVorschub;40\nWeg [mm];Höhe [µm];Güte\n"
      "0,0;1,5;ok\n1,0;1,7;ok\n2,0;1,6;ok\n";
  const ProgramRun found = check(
      ProblemText{.columns = "position_column = \"Weg [mm]\"\nvalue_column = \"z\"\n"}.text(), csv);
  EXPECT_EQ(found.exit_code, 3);
  EXPECT_THAT(found.out, HasSubstr("Weg [mm], Höhe [µm], Güte"));
}

TEST_F(Check, FindsAFaultOfTheDataToo) {
  const ProgramRun found = check(ProblemText{}.text(), face_csv(64, 7, "7,seven"));
  EXPECT_EQ(found.exit_code, 3);
  EXPECT_THAT(found.out, AllOf(HasSubstr("line 9"), HasSubstr("file = \"face.csv\"")));
}

TEST_F(Check, FindsWhatIdentifyRefuses) {
  for (const BadInputs& list : bad_problems())
    for (const BadInput& bad : list.cases) {
      const TemporaryFolder folder;
      ProgramRun refused = run_on(bad, folder);
      const json found = json::parse(
          run_program({"check", "problem.toml", "--json", "-"}, {folder.path(), {}}).out);
      std::string what = refused.err.substr(std::string("slideway: ").size());
      what.pop_back();
      std::vector<std::string> messages;
      for (const json& fault : found["faults"]) messages.push_back(fault["message"]);
      EXPECT_THAT(messages, Contains(what)) << bad.name;
    }
}

TEST_F(Check, ShowsTheNotesOfEachProfile) {
  const std::string second =
      "[[profile]]\nname = \"cut2\"\nfile = \"cut2.csv\"\nposition_column = \"x_um\"\n"
      "value_column = \"z_um\"\nposition_unit = \"um\"\nvalue_unit = \"um\"\n";
  const std::string note =
      "positions of cut2 may be in another unit: its trace is 1000 times shorter than that of face";
  write_file(path("cut2.csv"), "x_um" + face_csv(64).substr(4));
  const ProgramRun good =
      check(ProblemText{.effect = "[[effect]]\nname = \"squareness\"\n" + second}.text());
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("    - positions of cut2 may be in another unit"));
  for (const std::string& line : lines_of(good.out)) EXPECT_LE(code_points(line), 80U) << line;
  const json document = json::parse(run({"check", "problem.toml", "--json", "-"}).out);
  EXPECT_THAT(document["notes"], Contains(json{{"profile", "cut2"}, {"note", note}}));
}

TEST_F(Check, SaysWhatTheProfilesCanDetermineWithoutAFit) {
  const ProgramRun good = check(ProblemText{.effect = "[[effect]]\nname = \"squareness\"\n"
                                                      "[[effect]]\nname = \"straightness\"\n"
                                                      "degree = 2\n"}
                                    .text());
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_EQ(good.err, "");
  // A levelled radius has no tilt left that a squareness could be read from.
  EXPECT_THAT(good.out, AllOf(HasSubstr("no fault"), HasSubstr("profile.face.free"),
                              HasSubstr("They do not determine"), HasSubstr("squareness.dbeta_xz"),
                              HasSubstr("thermal drift: needs feed_mm_per_min")));
  for (const std::string& line : lines_of(good.out)) EXPECT_LE(code_points(line), 80U) << line;
  const json document = json::parse(run({"check", "problem.toml", "--json", "-"}).out);
  EXPECT_EQ(document["schema"], "slideway.check/1");
  EXPECT_EQ(document["design"]["identifiable"], json::array({"straightness.b2"}));
}

TEST_F(Check, TellsEffectsThatLookAlikeInOneCut) {
  const std::string cut =
      "free = [\"offset\"]\nfeed_mm_per_min = 2\nspindle_rpm = 100\ncut_direction = \"inward\"\n";
  const ProgramRun one = check(ProblemText{.profile_more = cut}.text());
  EXPECT_EQ(one.exit_code, 0);
  // Of one cut at one feed, t = (R - r) / feed: a drift in time is a cone.
  const json document = json::parse(run({"check", "problem.toml", "--json", "-"}).out);
  double share = 0.0;
  for (const json& each : document["design"]["candidates"])
    if (each["effect"] == "linear_drift")
      for (const json& other : each["lookalikes"])
        if (other["effect"] == "squareness") share = other["share"];
  EXPECT_NEAR(share, 1.0, 1e-6);  // all of it, but for the ridge
}

}  // namespace
}  // namespace slideway::check_test
