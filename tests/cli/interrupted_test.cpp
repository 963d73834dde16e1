#include <gmock/gmock.h>

#include <csignal>

#include "cli/bad_input.hpp"

namespace slideway::interrupted_test {
namespace {

using testing::IsSubsetOf;
using Microseconds = std::chrono::microseconds;

/// Ends the program by a signal, earlier and later in the time it takes.
class Interrupted : public ProgramTest, public testing::WithParamInterface<int> {
 protected:
  static constexpr int kMoments = 12;

  /// `check` runs after every interrupted run.
  template <typename Check>
  void at_every_moment(const std::vector<std::string>& arguments, const Check& check) const {
    const auto begin = std::chrono::steady_clock::now();
    ASSERT_EQ(run(arguments).exit_code, 0);
    const auto whole =
        std::chrono::duration_cast<Microseconds>(std::chrono::steady_clock::now() - begin);
    for (int moment = 0; moment <= kMoments; ++moment) {
      run_program(arguments, {.folder = folder_.path(),
                              .signal = GetParam(),
                              .signal_after = whole * moment / kMoments});
      check();
    }
  }
};

TEST_P(Interrupted, ConvertLeavesTheNewFileOrNone) {
  folder_.file("face.csv", face_csv(100'000));
  ASSERT_EQ(run({"convert", "face.csv", "expected.x3p"}).exit_code, 0);
  const std::string expected = contents(path("expected.x3p"));
  at_every_moment({"convert", "face.csv", "out.x3p"}, [&] {
    EXPECT_THAT(names_in(folder_.path()), IsSubsetOf({"expected.x3p", "face.csv", "out.x3p"}));
    if (!exists(path("out.x3p"))) return;
    EXPECT_TRUE(contents(path("out.x3p")) == expected);
    std::filesystem::remove(path("out.x3p"));
  });
}

TEST_P(Interrupted, ConvertLeavesTheNewFileOrTheOld) {
  folder_.file("face.csv", face_csv(100'000));
  ASSERT_EQ(run({"convert", "face.csv", "expected.x3p"}).exit_code, 0);
  const std::string expected = contents(path("expected.x3p"));
  folder_.file("out.x3p", "old");
  at_every_moment({"convert", "face.csv", "out.x3p"}, [&] {
    EXPECT_THAT(names_in(folder_.path()),
                testing::ElementsAre("expected.x3p", "face.csv", "out.x3p"));
    const std::string out = contents(path("out.x3p"));
    EXPECT_TRUE(out == expected || out == "old");
    folder_.file("out.x3p", "old");
  });
}

TEST_P(Interrupted, SimulateLeavesWholeFilesOnly) {
  folder_.file("problem.toml",
               ProblemText{.more = "[truth]\nseed = 7\nnoise_um = 0.1\nsamples = 50000\n"}.text());
  folder_.file("face.csv", face_csv(64));
  ASSERT_EQ(run({"simulate", "problem.toml", "--out", "expected"}).exit_code, 0);
  const std::vector<std::string> names = names_in(path("expected"));
  at_every_moment({"simulate", "problem.toml", "--out", "out"}, [&] {
    if (!exists(path("out"))) return;
    EXPECT_THAT(names_in(path("out")), testing::IsSubsetOf(names));
    for (const std::string& name : names_in(path("out")))
      EXPECT_TRUE(contents(path("out/" + name)) == contents(path("expected/" + name))) << name;
    std::filesystem::remove_all(path("out"));
  });
}

INSTANTIATE_TEST_SUITE_P(Signal, Interrupted, testing::Values(SIGINT, SIGTERM),
                         [](const auto& signal) {
                           return std::string(signal.param == SIGINT ? "SIGINT" : "SIGTERM");
                         });

}  // namespace
}  // namespace slideway::interrupted_test
