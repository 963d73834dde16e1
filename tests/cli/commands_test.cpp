#include <gmock/gmock.h>

#include "cli/bad_input.hpp"
#include "slideway/report/layout.hpp"

namespace slideway {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<std::string> kCommands{"identify", "rank",      "fit",    "plan",
                                         "simulate", "decompose", "effects"};

class Program : public ProgramTest {};

void expect_fits_80_columns(const std::string& text) {
  for (const std::string& line : lines_of(text)) EXPECT_LE(code_points(line), 80U) << line;
}

TEST_F(Program, HelpListsEveryCommandAndExitCode) {
  const ProgramRun help = run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string& command : kCommands)
    EXPECT_THAT(help.out, HasSubstr("\n  " + command + " "));
  EXPECT_THAT(help.out, AllOf(HasSubstr("0 done"), HasSubstr("1 failed while working"),
                              HasSubstr("2 bad usage"), HasSubstr("3 unreadable or invalid data"),
                              HasSubstr("4 negative verdict (--strict only)")));
  expect_fits_80_columns(help.out);
  EXPECT_EQ(run({"-h"}).out, help.out);
}

TEST_F(Program, EveryCommandHasHelpThatNeedsNoInput) {
  for (const std::string& command : kCommands) {
    const ProgramRun help = run({command, "--help"});
    EXPECT_EQ(help.exit_code, 0) << command;
    EXPECT_EQ(help.err, "") << command;
    EXPECT_THAT(help.out, AllOf(StartsWith("slideway " + command + " "), HasSubstr("--help")));
    expect_fits_80_columns(help.out);
  }
}

TEST_F(Program, HelpOfACommandListsTheOptionsOfTheInterface) {
  const std::map<std::string, std::vector<std::string>> options{
      {"identify", {"PROBLEM", "--json FILE", "--quiet", "--data DIR", "--strict", "--no-trace"}},
      {"rank", {"PROBLEM", "FILE.csv", "--signal COL", "--candidates COL...", "--json", "--quiet"}},
      {"fit", {"PROBLEM", "--json FILE", "--quiet", "--data DIR", "--strict"}},
      {"plan", {"PROBLEM", "--json FILE", "--html FILE", "--out DIR", "--data DIR", "--quiet"}},
      {"simulate", {"PROBLEM", "--out DIR", "--seed N", "--data DIR"}},
      {"decompose", {"FILE", "--wavelet", "--level", "--boundary", "--out OUT.csv"}},
      {"effects", {"[NAME|FILE.toml]", "--problem FILE", "--json FILE", "--quiet"}}};
  for (const auto& [command, texts] : options) {
    const std::string help = run({command, "--help"}).out;
    for (const std::string& text : texts) EXPECT_THAT(help, HasSubstr(text)) << command;
  }
}

TEST_F(Program, SaysItsVersion) {
  const ProgramRun version = run({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_EQ(version.out, "slideway 0.2.0\n");
  EXPECT_EQ(version.err, "");
}

class Usage : public ProgramTest, public testing::WithParamInterface<BadUsage> {};

TEST_P(Usage, IsRefusedInOneLine) {
  const ProgramRun refused = run(GetParam().arguments);
  EXPECT_TRUE(is_refused(refused, 2));
  EXPECT_THAT(refused.err, StartsWith("slideway: "));
  for (const std::string& fragment : GetParam().fragments)
    EXPECT_THAT(refused.err, HasSubstr(fragment));
  EXPECT_THAT(names_in(folder_.path()), testing::IsEmpty());
}

const BadUsage kBadUsages[] = {
    {"EmptyCommand", {""}, {"unknown command ''", "accepted: demo"}},
    {"UnknownCommand",
     {"identfy", "problem.toml"},
     {"unknown command 'identfy'", "did you mean 'identify'?", "accepted: demo init"}},
    {"UnknownOptionOfTheProgram",
     {"--verson"},
     {"unknown option '--verson'", "did you mean '--version'?", "accepted:"}},
    {"UnknownOption",
     {"identify", "problem.toml", "--jsno", "x"},
     {"identify: unknown option '--jsno'", "did you mean '--json'?",
      "accepted: --help --quiet --json"}},
    {"UnknownShortOption",
     {"fit", "problem.toml", "-x"},
     {"fit: unknown option '-x'", "accepted:"}},
    {"AbbreviatedOption",
     {"identify", "problem.toml", "--stric"},
     {"unknown option '--stric'", "did you mean '--strict'?"}},
    {"OptionOfAnotherCommand",
     {"rank", "problem.toml", "--strict"},
     {"rank: unknown option '--strict'", "accepted:"}},
    {"TimeLimitThatIsNoTime",
     {"identify", "problem.toml", "--time-limit", "-1"},
     {"identify: --time-limit: accepted: seconds above 0 and below 1e9"}},
    {"MissingOptionValue",
     {"identify", "problem.toml", "--json"},
     {"identify:", "'--json' is missing", "usage: slideway identify PROBLEM"}},
    {"ValueOfASwitch", {"identify", "problem.toml", "--strict=1"}, {"identify:", "'--strict'"}},
    {"OptionGivenTwice",
     {"identify", "problem.toml", "--json", "a", "--json", "b"},
     {"identify:", "'--json'", "more than once"}},
    {"MissingProblem",
     {"identify"},
     {"identify: PROBLEM is missing", "usage: slideway identify PROBLEM"}},
    {"EmptyProblem", {"identify", ""}, {"identify: PROBLEM is missing"}},
    {"MissingProblemOfFit", {"fit", "--quiet"}, {"fit: PROBLEM is missing"}},
    {"MissingProblemOfRank", {"rank"}, {"rank: PROBLEM is missing", "FILE.csv --signal COL"}},
    {"MissingProblemOfSimulate", {"simulate", "--out", "d"}, {"simulate: PROBLEM is missing"}},
    {"MissingFile", {"decompose", "--out", "o.csv"}, {"decompose: FILE is missing"}},
    {"TooManyArguments",
     {"identify", "a.toml", "b.toml"},
     {"identify: too many arguments", "usage: slideway identify PROBLEM"}},
    {"TooManyNames", {"effects", "cup", "step"}, {"effects: too many arguments"}},
    {"MissingOut", {"simulate", "problem.toml"}, {"simulate: --out DIR is missing"}},
    {"MissingOutFile", {"decompose", "face.csv"}, {"decompose: --out OUT.csv is missing"}},
    {"MissingPage", {"report", "result.json"}, {"report: --html FILE is missing"}},
    {"OneFileForTwoOutputs",
     {"identify", "problem.toml", "--json", "a", "--html", "a"},
     {"identify: --json and --html name one file, a", "accepted: two"}},
    {"MissingCandidates",
     {"rank", "f.csv", "--signal", "a"},
     {"rank: --candidates COL... is missing"}},
    {"FileBehindCandidates",
     {"rank", "--signal", "a", "--candidates", "b", "c", "f.csv"},
     {"rank: FILE.csv is missing; put it first"}},
    {"MissingSignal", {"rank", "f.csv", "--candidates", "a"}, {"--candidates needs --signal COL"}},
    {"LowBandOptionOfAProblem",
     {"rank", "problem.toml", "--level", "3"},
     {"--level", "[low_band]"}},
    {"LevelOutOfRange",
     {"decompose", "f.csv", "--out", "o.csv", "--level", "31"},
     {"--level: 31 is out of range", "accepted: 1 to 30"}},
    {"LevelThatIsNoNumber",
     {"decompose", "f.csv", "--out", "o.csv", "--level", "five"},
     {"decompose:", "'five'", "'--level'", "--help"}},
    {"UnknownWavelet",
     {"decompose", "f.csv", "--out", "o.csv", "--wavelet", "haar"},
     {"--wavelet:", "'haar'", "accepted: db1 ... db19"}},
    {"UnknownBoundary",
     {"rank", "f.csv", "--signal", "a", "--candidates", "b", "--boundary", "mirror"},
     {"--boundary:", "'mirror'", "accepted: zero constant symmetric"}},
    {"UnknownEffect",
     {"effects", "straightnes"},
     {"unknown effect 'straightnes'", "did you mean 'straightness'?", "accepted: straightness"}},
    {"EmptyEffect", {"effects", ""}, {"unknown effect ''", "accepted: straightness"}},
    {"NegativeSeed",
     {"simulate", "problem.toml", "--out", "d", "--seed", "-1"},
     {"--seed: '-1'", "accepted: a whole number from 0 to 2^64 - 1"}},
    {"SeedThatIsNoNumber",
     {"simulate", "problem.toml", "--out", "d", "--seed", "1.5"},
     {"--seed: '1.5'", "accepted: a whole number"}},
    {"SeedAbove64Bits",
     {"simulate", "problem.toml", "--out", "d", "--seed", "18446744073709551616"},
     {"--seed:", "accepted: a whole number"}},
    {"LineBreakInAName", {"identify", "a\nb.toml"}, {"a b.toml: cannot be read"}},
    {"TerminalSequenceInAName", {"\x1b[31midentify"}, {"unknown command '?[31midentify'"}},
};

INSTANTIATE_TEST_SUITE_P(Bad, Usage, testing::ValuesIn(kBadUsages),
                         [](const auto& usage) { return usage.param.name; });

}  // namespace

std::span<const BadUsage> bad_usages() { return kBadUsages; }

}  // namespace slideway
