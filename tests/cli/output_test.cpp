#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"

namespace slideway {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

const std::string kProblem = shipped("problems/paper-600mm/problem.toml");

class Output : public ProgramTest {
 protected:
  /// The line with which a run fails that could not write; "" if it did not fail so.
  static std::string failure(const ProgramRun& run) {
    EXPECT_TRUE(is_refused(run, 1));
    EXPECT_THAT(run.err, HasSubstr("cannot be written"));
    return run.err;
  }
};

TEST_F(Output, GoesToTheJsonFileAndAsTextToStdout) {
  const ProgramRun done = run({"identify", kProblem, "--no-trace", "--json", "report.json"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(done.out, run({"identify", kProblem, "--no-trace"}).out);
  EXPECT_EQ(contents(path("report.json")),
            run({"identify", kProblem, "--no-trace", "--json", "-"}).out);
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("report.json"));
}

TEST_F(Output, IsSuppressedByQuietButForTheJsonFile) {
  const ProgramRun done =
      run({"identify", kProblem, "--no-trace", "--quiet", "--json", "report.json"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_EQ(done.out, "");
  EXPECT_EQ(done.err, "");
  EXPECT_TRUE(nlohmann::json::accept(contents(path("report.json"))));
  for (const char* command : {"fit", "rank"}) {
    const ProgramRun quiet = run({command, kProblem, "-q"});
    EXPECT_EQ(quiet.exit_code, 0) << command;
    EXPECT_EQ(quiet.out + quiet.err, "") << command;
  }
}

TEST_F(Output, ReplacesAnOlderReport) {
  folder_.file("report.json", std::string(1'000'000, 'x'));
  EXPECT_EQ(run({"identify", kProblem, "--no-trace", "--json", "report.json"}).exit_code, 0);
  EXPECT_TRUE(nlohmann::json::accept(contents(path("report.json"))));
}

TEST_F(Output, OnAFullDiskFailsWithAMessage) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full on this system";
  const ProgramSetup full{folder_.path(), "/dev/full"};
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"--help"},
           {"--version"},
           {"identify", "--help"},
           {"effects"},
           {"identify", kProblem, "--no-trace"},
           {"identify", kProblem, "--no-trace", "--json", "-"},
           {"decompose", shipped("data/axis-ranking.csv"), "--out", "-"}})
    EXPECT_THAT(failure(run_program(arguments, full)),
                testing::StartsWith("slideway: standard output: "));
  EXPECT_THAT(failure(run({"identify", kProblem, "--no-trace", "--json", "/dev/full"})),
              testing::StartsWith("slideway: /dev/full: "));
  EXPECT_THAT(failure(run({"decompose", shipped("data/axis-ranking.csv"), "--out", "/dev/full"})),
              testing::StartsWith("slideway: /dev/full: "));
}

TEST_F(Output, IntoAClosedPipeFailsWithAMessage) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  ::close(ends[0]);
  const ProgramRun broken =
      run_program({"effects"}, {.folder = folder_.path(), .stdout_number = ends[1]});
  ::close(ends[1]);
  EXPECT_EQ(failure(broken), "slideway: standard output: cannot be written: Broken pipe\n");
}

class BadOutputs : public Output, public testing::WithParamInterface<BadUsage> {};

TEST_P(BadOutputs, FailInOneLine) {
  const std::string said =
      failure(run_program(GetParam().arguments, {folder_.path(), GetParam().stdout_to}));
  for (const std::string& fragment : GetParam().fragments) EXPECT_THAT(said, HasSubstr(fragment));
  EXPECT_THAT(names_in(folder_.path()), IsEmpty());
}

std::vector<std::string> identify_to(const std::string& json) {
  return {"identify", kProblem, "--no-trace", "--json", json};
}

const BadUsage kBadOutputs[] = {
    {"StandardOutputOnAFullDisk",
     {"effects"},
     {"standard output: cannot be written: No space left on device"},
     "/dev/full"},
    {"FileOnAFullDisk",
     identify_to("/dev/full"),
     {"/dev/full: cannot be written: No space left on device"}},
    {"IntoADirectoryThatIsNotThere",
     identify_to("gone/report.json"),
     {"gone/report.json: cannot be written: No such file or directory"}},
    // Not even root's.
    {"IntoADirectoryThatTakesNoFiles", identify_to("/proc/report.json"), {"/proc/report.json: "}},
    {"OverADirectory", identify_to("."), {".: cannot be written: Is a directory"}},
    {"BehindAFile", identify_to("/dev/null/report.json"), {"Not a directory"}},
};
INSTANTIATE_TEST_SUITE_P(Bad, BadOutputs, testing::ValuesIn(kBadOutputs),
                         [](const auto& output) { return output.param.name; });

TEST_F(Output, HoldsNoLogLinesOfLibraries) {
  folder_.file("problem.toml", ProblemText{}.text());
  folder_.file("face.csv", face_csv(64));
  const ProgramRun done =
      run_program({"identify", "problem.toml"},
                  {folder_.path(), {}, {{"GLOG_v", "9"}, {"GLOG_logtostderr", "1"}}});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_EQ(done.err, "");
}

TEST_F(Output, NeverReplacesTheInput) {
  const std::string problem = ProblemText{}.text(), csv = face_csv(64);
  folder_.file("problem.toml", problem);
  folder_.file("face.csv", csv);
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"identify", "problem.toml", "--json", "problem.toml"},
           {"fit", "problem.toml", "--json", "./problem.toml"},
           {"identify", "problem.toml", "--json", "face.csv"},
           {"rank", "face.csv", "--signal", "1", "--candidates", "2", "--json", "face.csv"},
           {"decompose", "face.csv", "--level", "1", "--out", "face.csv"}}) {
    const ProgramRun refused = run(arguments);
    EXPECT_TRUE(is_refused(refused, 2));
    EXPECT_THAT(refused.err, HasSubstr("is the input, which would be lost"));
  }
  EXPECT_EQ(contents(path("problem.toml")), problem);
  EXPECT_EQ(contents(path("face.csv")), csv);
}

class Inputs : public Output {
 protected:
  /// A problem with a log and a file of effects.
  void SetUp() override {
    folder_.file("problem.toml",
                 ProblemText{.machine = "effects = [\"shop.toml\"]\n[machine]\nlever = \"paper\"\n",
                             .profile_more = "start_s = 0\nfeed_mm_per_min = 60\n"
                                             "spindle_rpm = 100\ncut_direction = \"inward\"\n",
                             .more = "[[channel]]\nname = \"oil\"\nfile = \"oil.csv\"\n"
                                     "time_column = \"t\"\nvalue_column = \"T\"\n"
                                     "time_unit = \"s\"\n"}
                     .text());
    folder_.file("face.csv", face_csv(64));
    folder_.file("oil.csv", "t,T\n0,20\n100,21\n200,25\n");
    folder_.file("shop.toml",
                 "[[effect]]\nname = \"formula\"\nas = \"kink\"\nformula = \"a * r^3\"\n"
                 "parameters = [{ name = \"a\", unit = \"um\" }]\ncause = \"c\"\n"
                 "source = \"s\"\ntypical = \"t\"\n");
  }
};

TEST_F(Inputs, ThatAProblemNamesAreNeverReplaced) {
  ASSERT_EQ(run({"check", "problem.toml"}).exit_code, 0);
  std::filesystem::create_symlink("oil.csv", path("link.csv"));
  for (const char* input : {"oil.csv", "./shop.toml", "link.csv", "face.csv"}) {
    for (const char* command : {"identify", "fit", "rank", "check", "plan"}) {
      const ProgramRun refused = run({command, "problem.toml", "--json", input});
      EXPECT_TRUE(is_refused(refused, 2)) << command << ' ' << input;
      EXPECT_THAT(refused.err, HasSubstr("is the input, which would be lost"));
    }
    folder_.file("list.csv", "problem\nproblem.toml\n");
    EXPECT_TRUE(is_refused(run({"batch", "list.csv", "--out", input}), 2)) << input;
    EXPECT_TRUE(is_refused(run({"batch", "list.csv", "--out", "out.jsonl", "--json", input}), 2));
  }
  EXPECT_THAT(contents(path("oil.csv")), testing::StartsWith("t,T"));
  EXPECT_THAT(contents(path("shop.toml")), testing::StartsWith("[[effect]]"));
}

TEST_F(Inputs, AreNotReplacedWhereTheProblemHasFaults) {
  folder_.file("problem.toml", ProblemText{.effect = "[[effect]]\nname = \"squarenes\"\n"}.text());
  EXPECT_TRUE(is_refused(run({"check", "problem.toml", "--json", "face.csv"}), 2));
  EXPECT_EQ(contents(path("face.csv")), face_csv(64));
}

TEST_F(Inputs, AndOutputsAreFilesNotNames) {
  std::filesystem::create_symlink("o.json", path("o.html"));
  for (const char* page : {"./o.json", "o.html", "o.json"}) {
    const ProgramRun refused =
        run({"identify", "problem.toml", "--json", "o.json", "--html", page});
    EXPECT_TRUE(is_refused(refused, 2)) << page;
    EXPECT_THAT(refused.err, HasSubstr("name one file"));
  }
  folder_.file("list.csv", "problem\nproblem.toml\n");
  EXPECT_TRUE(is_refused(run({"batch", "list.csv", "--out", "o", "--json", "./o"}), 2));
  EXPECT_FALSE(std::filesystem::exists(path("o.json")));
}

TEST_F(Inputs, ThatMayNeverEndAreRefused) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"identify", "pipe"},
                                             {"check", "/dev/zero"},
                                             {"simulate", "pipe", "--out", "d"},
                                             {"diff", "pipe", "/dev/zero"},
                                             {"export", "/dev/zero", "--to", "isg"},
                                             {"report", "pipe", "--html", "o.html"},
                                             {"batch", "pipe", "--out", "o"},
                                             {"batch", "verify", "pipe", "problem.toml"}}) {
    const ProgramRun refused = run(arguments);
    EXPECT_NE(refused.exit_code, 0) << arguments[0];
    EXPECT_THAT(refused.out + refused.err, HasSubstr("is a pipe or a device, expected a file"));
  }
  folder_.file(
      "problem.toml",
      ProblemText{.machine = "effects = [\"pipe\"]\n[machine]\nlever = \"paper\"\n"}.text());
  EXPECT_TRUE(is_refused(run({"fit", "problem.toml"}), 2));
}

}  // namespace

std::span<const BadUsage> bad_outputs() { return kBadOutputs; }

}  // namespace slideway
