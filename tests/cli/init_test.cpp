#include <gmock/gmock.h>

#include <cmath>

#include "cli/run_program.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"

namespace slideway::init_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A trace from the rim over the centre to the rim, as a German instrument writes it.
std::string german_csv(const std::string& letter_o, const std::string& micro) {
  std::string text =
      "Messprotokoll Planfl\xe4"
      "che;\n";
  if (letter_o.size() > 1) text = "Messprotokoll Planfläche;\n";
  text += "Maschine;LT-3\nDatum;12.03.2026\nVorschub;40\nWeg [mm];H" + letter_o + "he [" + micro +
          "m]\n";
  for (int i = 0; i <= 800; ++i) {
    const double x = 0.1 * i, r = std::abs(x - 40.0);
    std::string row = significant(x, 6) + ";" + significant(1.0 - 0.02 * r + 0.0003 * r * r, 6);
    for (char& c : row)
      if (c == '.') c = ',';
    text += row + "\n";
  }
  return text;
}

const std::vector<std::string> kFace{"--kind", "face",        "--trace",     "diameter", "--center",
                                     "40",     "--feed",      "40",          "--speed",  "800",
                                     "--free", "offset,tilt", "--direction", "inward",   "--lever",
                                     "split",  "--overhang",  "60"};

class Init : public ProgramTest {
 protected:
  [[nodiscard]] ProgramRun init(std::vector<std::string> arguments,
                                const std::vector<std::string>& answers = kFace) const {
    arguments.insert(arguments.begin(), "init");
    arguments.insert(arguments.end(), answers.begin(), answers.end());
    return run(arguments);
  }
};

TEST_F(Init, MakesAProblemOfAGermanFileThatRuns) {
  for (const auto& [name, text] :
       {std::pair("utf8", german_csv("ö", "µ")), std::pair("latin1", german_csv("\xf6", "\xb5"))}) {
    write_file(path("plan.csv"), text);
    const std::string out = name + std::string(".toml");
    const ProgramRun made = init({"plan.csv", "--out", out});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, AllOf(HasSubstr("semicolons between columns, decimal comma"),
                                HasSubstr("Weg [mm] (mm), Höhe [µm] (um)"),
                                HasSubstr("801 readings at 0 to 80"), HasSubstr("slideway check")));
    const std::string problem = contents(path(out));
    EXPECT_THAT(problem, AllOf(HasSubstr("position_column = \"Weg [mm]\""),
                               HasSubstr("center_mm = 40"), HasSubstr("lever = \"split\""),
                               Not(HasSubstr("value_unit")), Not(HasSubstr("position_unit"))));
    EXPECT_EQ(run({"check", out}).exit_code, 0);
    EXPECT_EQ(run({"identify", "--no-trace", out}).exit_code, 0);
  }
}

TEST_F(Init, ListsEverythingThatIsMissingAtOnce) {
  write_file(path("plan.csv"), "a;b\n0;1\n1;2\n2;1\n");
  const ProgramRun refused = init({"plan.csv"}, {});
  EXPECT_TRUE(is_refused(refused, 2) || !refused.out.empty());
  EXPECT_EQ(refused.exit_code, 2);
  for (const char* option : {"--position-unit", "--value-unit", "--kind", "--free"})
    EXPECT_THAT(refused.err, HasSubstr(option));
  EXPECT_FALSE(std::filesystem::exists(path("problem.toml")));
}

TEST_F(Init, NeverAsksWhatTheFileStates) {
  write_file(path("plan.csv"), german_csv("ö", "µ"));
  const std::string missing = init({"plan.csv"}, {}).err;
  EXPECT_THAT(missing, AllOf(Not(HasSubstr("--position-unit")), Not(HasSubstr("--value-unit")),
                             Not(HasSubstr("column")), HasSubstr("--lever")));
}

TEST_F(Init, TakesAnAnswerForEachFileOrOneForAll) {
  write_file(path("a.csv"), german_csv("ö", "µ"));
  write_file(path("b.csv"), german_csv("ö", "µ"));
  std::vector<std::string> answers = kFace;
  answers.insert(answers.end(), {"--feed", "100"});
  ASSERT_EQ(init({"a.csv", "b.csv"}, answers).exit_code, 0);
  EXPECT_THAT(contents(path("problem.toml")),
              AllOf(HasSubstr("name = \"a\""), HasSubstr("name = \"b\""),
                    HasSubstr("feed_mm_per_min = 40"), HasSubstr("feed_mm_per_min = 100")));
  EXPECT_EQ(run({"check", "problem.toml"}).exit_code, 0);
}

TEST_F(Init, KeepsWhatIsThere) {
  write_file(path("plan.csv"), german_csv("ö", "µ"));
  write_file(path("problem.toml"), "mine");
  EXPECT_TRUE(is_refused(init({"plan.csv"}), 2));
  EXPECT_EQ(contents(path("problem.toml")), "mine");
  EXPECT_EQ(init({"plan.csv", "--force"}).exit_code, 0);
  EXPECT_TRUE(is_refused(init({"plan.csv", "--out", "plan.csv"}), 2));
  EXPECT_TRUE(is_refused(init({"plan.csv", "--out", "nowhere/problem.toml"}), 1));
}

TEST_F(Init, KnowsASlideByItsAngles) {
  std::string text = "station,t_s,x_origin_mm,slope_arcsec\n";
  for (int i = 0; i < 12; ++i) {
    const std::string n = std::to_string(i);
    text += n + "," + n + "5," + n + "00,0." + std::to_string(i % 4) + "\n";
  }
  write_file(path("bed.csv"), text);
  ASSERT_EQ(init({"bed.csv"}, {"--base", "100", "--free", "offset"}).exit_code, 0);
  EXPECT_THAT(contents(path("problem.toml")),
              AllOf(HasSubstr("kind = \"slide\""), HasSubstr("quantity = \"slope\""),
                    HasSubstr("position_column = \"x_origin_mm\""), HasSubstr("base_mm = 100"),
                    Not(HasSubstr("[machine]"))));
  EXPECT_EQ(run({"check", "problem.toml"}).exit_code, 0);
}

TEST_F(Init, RefusesAnAnswerThatIsNone) {
  write_file(path("plan.csv"), german_csv("ö", "µ"));
  std::vector<std::string> answers = kFace;
  answers[7] = "fast";
  const ProgramRun refused = init({"plan.csv"}, answers);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--feed: 'fast' is no answer; accepted: mm/min"));
}

}  // namespace
}  // namespace slideway::init_test
