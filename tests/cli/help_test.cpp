#include <gmock/gmock.h>

#include <cstdlib>
#include <set>

#include "cli/run_program.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/layout.hpp"

namespace slideway::help_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

class Help : public ProgramTest {
 protected:
  [[nodiscard]] std::vector<std::string> commands() const {
    std::vector<std::string> names;
    bool listed = false;
    for (const std::string& line : lines_of(run({"help"}).out)) {
      if (listed && line.empty()) break;
      if (listed) names.push_back(line.substr(2, line.find(' ', 2) - 2));
      listed = listed || line == "Commands:";
    }
    return names;
  }

  /// Whether a shell runs that script; a shell that is not installed is no failure.
  [[nodiscard]] std::string output_of_shell(const std::string& shell, const std::string& script) {
    write_file(path("script"), script);
    const std::string command = "cd '" + folder_.path().string() + "' && " + shell +
                                " script > said 2>&1 || echo failed >> said";
    EXPECT_EQ(std::system(command.c_str()), 0);
    return contents(path("said"));
  }
  [[nodiscard]] static bool has(const std::string& program) {
    return std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) == 0;
  }

  /// What bash offers behind these words, the last one begun.
  [[nodiscard]] std::vector<std::string> offered(const std::string& words) {
    const std::string said =
        output_of_shell("bash", ". ./slideway.bash\nCOMP_WORDS=(" + words +
                                    ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_slideway\n"
                                    "printf '%s\\n' \"${COMPREPLY[@]}\"\n");
    return lines_of(said);
  }
};

TEST_F(Help, ExplainsEveryCommandAsItsOwnHelpDoes) {
  ASSERT_THAT(commands(), testing::IsSupersetOf({"identify", "effects", "diff", "export", "help"}));
  for (const std::string& command : commands()) {
    const ProgramRun help = run({"help", command});
    EXPECT_EQ(help.exit_code, 0);
    if (command != "effects") {  // a concept first
      EXPECT_EQ(help.out, run({command, "--help"}).out);
      EXPECT_THAT(help.out, HasSubstr("--quiet")) << command;
    }
    for (const std::string& line : lines_of(help.out)) EXPECT_LE(code_points(line), 80U) << line;
  }
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
}

TEST_F(Help, KnowsTheConcepts) {
  for (const char* topic : {"effects", "problem-file"}) {
    const ProgramRun help = run({"help", topic});
    EXPECT_EQ(help.exit_code, 0);
    for (const std::string& line : lines_of(help.out)) EXPECT_LE(code_points(line), 80U) << line;
  }
  EXPECT_TRUE(is_refused(run({"help", "efects"}), 2));
  EXPECT_THAT(run({"help", "efects"}).err, HasSubstr("did you mean 'effects'?"));
}

const std::string kProfile =
    "[[profile]]\nname = \"a\"\nfile = \"a.csv\"\nkind = \"slide\"\nposition_unit = \"mm\"\n"
    "value_unit = \"um\"\n";
const std::string kEffect = "[[effect]]\nname = \"straightness\"\ndegree = 2\n";
const std::string kGood = kProfile + kEffect;

// A problem with a key too many in each section, by the section's heading in the help.
const std::map<std::string, std::string> kTooMany{
    {"", "zzz = 1\n" + kGood},
    {"[about]", "[about]\nzzz = 1\n" + kGood},
    {"[tolerance]", "[tolerance]\nzzz = 1\n" + kGood},
    {"[machine]", "[machine]\nzzz = 1\n" + kGood},
    {"[[machine.body]]", "[[machine.body]]\nzzz = 1\n" + kGood},
    {"[low_band]", "[low_band]\nzzz = 1\n" + kGood},
    {"[[profile]]", kProfile + "zzz = 1\n" + kEffect},
    {"[[effect]]", kGood + "zzz = 1\n"},
    {"[[effect]] name = \"formula\"",
     kGood + "[[effect]]\nname = \"formula\"\nas = \"b\"\nzzz = 1\n"},
    {"[[channel]]", "[[channel]]\nzzz = 1\n" + kGood},
    {"[[effect]] name = \"channel\"", kGood + "[[effect]]\nname = \"channel\"\nzzz = 1\n"},
    {"priors = [{ ... }]", kGood + "priors = [{ zzz = 1 }]\n"},
    {"[runout]", kGood + "[runout]\nzzz = 1\n"},
    {"[trace]", kGood + "[trace]\nzzz = 1\n"},
    {"[[plan.cut]]", kGood + "[[plan.cut]]\nname = \"b\"\nzzz = 1\n"},
    {"[truth]", kGood + "[truth]\nzzz = 1\n"}};

TEST_F(Help, ListsTheKeysOfTheProblemFileThatTheReaderAccepts) {
  std::map<std::string, std::set<std::string>> documented;
  std::string section;
  for (const std::string& line : lines_of(run({"help", "problem-file"}).out)) {
    if (line.starts_with("[") || line.starts_with("priors = ")) section = line;
    if (line.starts_with("    ") && line[4] != ' ')
      documented[section].insert(line.substr(4, line.find(' ', 4) - 4));
  }
  for (const char* table : {"about", "tolerance", "machine", "low_band", "profile", "channel",
                            "effect", "runout", "trace", "plan", "truth"})
    documented[""].insert(table);
  const std::set<std::string> of_a_file{
      "file",      "delimiter", "decimal", "encoding", "header_lines", "line",     "mask",
      "leave_out", "from_mm",   "to_mm",   "role",     "time_column",  "time_unit"};
  const std::set<std::string> of_any = documented["[[effect]]"];
  for (const char* kind : {"formula", "channel"})
    documented[std::string("[[effect]] name = \"") + kind + "\""].insert(of_any.begin(),
                                                                         of_any.end());
  for (const std::string& key : documented["[[profile]]"])
    if (!of_a_file.contains(key)) documented["[[plan.cut]]"].insert(key);
  for (const auto& [heading, problem] : kTooMany) {
    write_file(path("problem.toml"), problem);
    const std::string why = run({"fit", "problem.toml"}).err;
    const std::size_t accepted = why.find("accepted: ");
    ASSERT_NE(accepted, std::string::npos) << heading << ": " << why;
    std::istringstream words(why.substr(accepted + 10));
    EXPECT_EQ(documented[heading],
              (std::set<std::string>{std::istream_iterator<std::string>(words), {}}))
        << heading;
  }
  EXPECT_EQ(documented.size(), kTooMany.size());
}

TEST_F(Help, MakesManualPagesOfTheSameWords) {
  for (const std::string& command : commands()) {
    const std::string page = run({"help", command, "--man"}).out;
    EXPECT_THAT(page, testing::StartsWith(".TH SLIDEWAY-"));
    const std::string help = run({"help", command}).out;
    for (std::size_t at = help.find("--"); at != std::string::npos; at = help.find("--", at + 2)) {
      const std::string option = help.substr(at + 2, help.find_first_of(" ,\n]", at) - at - 2);
      if (option.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") != std::string::npos) continue;
      std::string escaped = "\\-\\-";
      for (const char c : option) escaped += c == '-' ? "\\-" : std::string(1, c);
      EXPECT_THAT(page, HasSubstr(escaped)) << command;
    }
    // A line that begins with a period or an apostrophe is a request.
    for (const std::string& line : lines_of(page)) {
      if (!line.empty() && (line[0] == '.' || line[0] == '\'')) {
        EXPECT_THAT(line, testing::MatchesRegex("\\.(TH|SH|TP|B|BR|br|ad) ?.*")) << command;
      }
    }
  }
  EXPECT_THAT(run({"help", "--man"}).out, HasSubstr(".BR slideway\\-identify (1)"));
  EXPECT_TRUE(is_refused(run({"help", "problem-file", "--man"}), 2));
}

TEST_F(Help, ManualPagesPassTheFormatter) {
  if (!has("man")) GTEST_SKIP() << "no man";
  for (const std::string& command : commands()) {
    EXPECT_EQ(run({"help", command, "--man", "--out", "page.1"}).exit_code, 0);
    const std::string said = output_of_shell(
        "sh", "LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -E UTF-8 -l page.1 > page");
    EXPECT_EQ(said, "") << command;
    EXPECT_THAT(contents(path("page")), HasSubstr("slideway " + command));
  }
}

TEST_F(Help, BashCompletesCommandsOptionsAndWords) {
  ASSERT_EQ(run({"help", "--completion", "bash", "--out", "slideway.bash"}).exit_code, 0);
  EXPECT_THAT(offered("slideway iden"), testing::ElementsAre("identify"));
  EXPECT_THAT(offered("slideway identify --no"), testing::ElementsAre("--no-trace"));
  EXPECT_THAT(offered("slideway decompose a.csv --boundary refl"), testing::ElementsAre("reflect"));
  EXPECT_THAT(offered("slideway decompose --wavelet db1"), Contains("db19"));
  EXPECT_THAT(offered("slideway effects thermal"), testing::ElementsAre("thermal_drift"));
  EXPECT_THAT(offered("slideway help prob"), testing::ElementsAre("problem-file"));
  EXPECT_THAT(offered("slideway export r.json --to e"), testing::ElementsAre("etalon"));
  EXPECT_THAT(offered("slideway nonsense --x"), testing::ElementsAre(""));
  for (const std::string& command : commands())
    EXPECT_THAT(offered("slideway " + command + " --"), Contains("--help"));
}

TEST_F(Help, CompletionScriptsAreGoodShell) {
  for (const std::string shell : {"bash", "zsh"}) {
    if (!has(shell)) continue;
    const std::string script = run({"help", "--completion", shell}).out;
    EXPECT_EQ(output_of_shell(shell + " -n", script), "") << shell;
  }
  EXPECT_TRUE(is_refused(run({"help", "--completion", "fish"}), 2));
}

}  // namespace
}  // namespace slideway::help_test
