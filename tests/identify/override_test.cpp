#include "slideway/identify/override.hpp"

#include "identify/problem_file.hpp"

namespace slideway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kText = std::string(kMachine) + "[low_band]\nlevel = 5\n" +
                          profile("feed_mm_per_min = 2.0\n") + profile("", "feed.8") +
                          "[[effect]]\nname = \"straightness\"\ndegree = 3\n"
                          "priors = [{ parameter = \"b1\", value = 0.0, "
                          "standard_uncertainty = 1e-8 }]\n";

class OverriddenProblem : public ProblemFile {
 protected:
  Problem with(const std::vector<Override>& overrides) {
    return read_problem(write(kText), std::nullopt, overrides);
  }
  std::string refused(const Override& override) {
    try {
      with({override});
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(OverriddenProblem, ReplacesWhatTheKeyLeadsTo) {
  const Problem problem = with({{"low_band.level", "3"},
                                {"profile.feed2.feed_mm_per_min", "8"},
                                {"profile.feed2.file", "2026.csv"},
                                {"profile.feed.8.z_mm", "1e1"},
                                {"effect.straightness.degree", "4"},
                                {"effect.straightness.priors.b1.value", "2.5e-6"}});
  EXPECT_EQ(problem.low_band.level, 3);
  EXPECT_EQ(problem.profiles[0].profile.setup.feed_mm_per_min, 8.0);
  EXPECT_EQ(problem.profiles[0].profile.file, "2026.csv");
  EXPECT_EQ(problem.profiles[1].profile.setup.z_mm, 10.0);
  EXPECT_EQ(problem.effects[0].options.degree, 4);
  EXPECT_EQ(problem.effects[0].priors[0].value, 2.5e-6);
}

TEST_F(OverriddenProblem, PutsInWhatIsNotThere) {
  const Problem problem = with({{"trace.significance", "0.05"},
                                {"title", "2026-11-21"},
                                {"profile.feed2.window", "[1, 9.5]"},
                                {"profile.feed2.free", "[\"offset\"]"},
                                {"runout.r_um", "0.3"},
                                {"runout.p_um", "2.5"},
                                {"runout.diameter_mm", "1000"},
                                {"runout.standard_uncertainty_um", "0.1"}});
  EXPECT_EQ(problem.trace.gates.significance, 0.05);
  EXPECT_EQ(problem.title, "2026-11-21");
  EXPECT_EQ(problem.profiles[0].source.window, std::pair(1.0, 9.5));
  EXPECT_FALSE(problem.profiles[0].profile.free_tilt);
  EXPECT_EQ(problem.runout.value().p_um, 2.5);
}

TEST_F(OverriddenProblem, ATextStaysATextWhereOneStands) {
  EXPECT_EQ(with({{"profile.feed2.file", "12"}}).profiles[0].profile.file, "12");
}

TEST_F(OverriddenProblem, IsCheckedAsIfItStoodInTheFile) {
  EXPECT_THAT(refused({"low_band.levle", "3"}),
              HasSubstr("problem.toml: low_band.levle: unknown key (did you mean 'level'?)"));
  EXPECT_THAT(refused({"low_band.level", "deep"}),
              HasSubstr("problem.toml: low_band.level: must be a whole number from 0 to 30"));
  EXPECT_THAT(refused({"profile.feed2.kind", "edge"}), HasSubstr("accepted: face slide"));
  EXPECT_THAT(refused({"speed", "3"}), HasSubstr("speed: unknown key"));
}

TEST_F(OverriddenProblem, AWayThatLeadsNowhereIsRefused) {
  EXPECT_THAT(refused({"profile.feed3.z_mm", "3"}),
              HasSubstr("profile.feed3.z_mm: leads to none of the tables of profile; accepted: "
                        "profile.NAME.KEY with a NAME of: feed2 feed.8"));
  EXPECT_THAT(refused({"profile.feed2", "3"}), HasSubstr("leads to none of the tables"));
  EXPECT_THAT(refused({"machine.lever.arm", "3"}), HasSubstr("machine.lever is no table"));
}

}  // namespace
}  // namespace slideway
