#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"

namespace slideway::simulate_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string kProblem = R"(title = "Two faces to simulate"
[machine]
lever = "paper"
[low_band]
level = 3
[[profile]]
name = "slow"
file = "none.csv"
position_unit = "mm"
value_unit = "um"
cut_radius_mm = 50.0
free = ["offset"]
[[profile]]
name = "fast"
file = "none.csv"
position_unit = "mm"
value_unit = "nm"
cut_radius_mm = 50.0
free = ["offset"]
[[effect]]
name = "squareness"
)";
const std::string kTruth = R"([truth]
seed = 1
noise_um = 0.01
samples = 2000
parameters = { "squareness.dbeta_xz" = 2.8e-6 }
)";

class Simulate : public ProgramTest {
 protected:
  Simulate() { folder_.file("problem.toml", kProblem + kTruth); }
  void simulate(const std::string& folder, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"simulate", "problem.toml", "--out", folder});
    const ProgramRun done = run(more);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    EXPECT_EQ(done.err, "");
    EXPECT_EQ(done.out, folder + "/problem.toml\n");
  }
};

TEST_F(Simulate, WritesProfilesAndAProblemThatIdentifyAccepts) {
  simulate("made/here");
  EXPECT_THAT(names_in(path("made/here")), ElementsAre("fast.csv", "problem.toml", "slow.csv"));
  EXPECT_THAT(contents(path("made/here/problem.toml")), Not(HasSubstr("truth")));
  EXPECT_EQ(lines_of(contents(path("made/here/slow.csv"))).size(), 2001U);
  const ProgramRun done = run({"identify", "made/here/problem.toml", "--no-trace", "--json", "-"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const nlohmann::json parameter = nlohmann::json::parse(done.out)["final"]["parameters"].at(0);
  // What went in comes back; U is 95 %, twice that fails with a normal error by 6e-5.
  EXPECT_NEAR(parameter["value"].get<double>(), 2.8e-6,
              2.0 * parameter["expanded_uncertainty"].get<double>());
  // A line over 50 mm in 4000 values of 0.01 um noise: u = 0.01e-3 / (sqrt(4000) 50 / sqrt(12)),
  // about 1.1e-8 rad.
  EXPECT_LT(parameter["expanded_uncertainty"].get<double>(), 5e-8);
}

TEST_F(Simulate, MakesTheSameBytesOfTheSameSeed) {
  simulate("first");
  simulate("second");
  simulate("third", {"--seed", "1"});  // that of [truth]
  for (const char* name : {"slow.csv", "fast.csv", "problem.toml"}) {
    EXPECT_EQ(contents(path("first") / name), contents(path("second") / name));
    EXPECT_EQ(contents(path("first") / name), contents(path("third") / name));
  }
}

TEST_F(Simulate, MakesOtherNoiseOfAnotherSeedAndForEachProfile) {
  simulate("first");
  simulate("second", {"--seed", "2"});
  simulate("last", {"--seed", "18446744073709551615"});
  const std::string slow = contents(path("first/slow.csv"));
  EXPECT_NE(slow, contents(path("second/slow.csv")));
  EXPECT_NE(slow, contents(path("last/slow.csv")));
  EXPECT_NE(slow, contents(path("first/fast.csv")));
}

TEST_F(Simulate, IntoTheSameFolderReplacesTheFormerSimulation) {
  simulate("made", {"--seed", "2"});
  simulate("made");
  simulate("other");
  EXPECT_EQ(contents(path("made/slow.csv")), contents(path("other/slow.csv")));
}

TEST_F(Simulate, NeverReplacesTheProblemNorItsData) {
  const ProgramRun refused = run({"simulate", "problem.toml", "--out", "."});
  EXPECT_TRUE(is_refused(refused, 2));
  EXPECT_THAT(refused.err, HasSubstr("problem.toml: is an input, which would be lost"));
  EXPECT_EQ(contents(path("problem.toml")), kProblem + kTruth);

  std::string measured = kProblem + kTruth;
  measured.replace(measured.find("none.csv"), 8, "slow.csv");
  folder_.file("measured.toml", measured);
  folder_.file("slow.csv", face_csv(51));
  EXPECT_TRUE(is_refused(run({"simulate", "measured.toml", "--out", "."}), 2));
  EXPECT_EQ(contents(path("slow.csv")), face_csv(51));
}

TEST_F(Simulate, IsAskedForWhereAPlannedCutIsIdentifiedBeforeItIsMade) {
  const std::string planned = shipped("problems/planned-cuts/problem.toml");
  for (const char* command : {"identify", "fit", "rank"}) {
    const ProgramRun refused = run({command, planned});
    EXPECT_TRUE(is_refused(refused, 3));
    EXPECT_THAT(refused.err, HasSubstr("slideway simulate " + planned + " --out DIR"));
  }
}

TEST_F(Simulate, NeedsATruth) {
  folder_.file("plain.toml", kProblem);
  const ProgramRun refused = run({"simulate", "plain.toml", "--out", "made"});
  EXPECT_TRUE(is_refused(refused, 2));
  EXPECT_THAT(refused.err, HasSubstr("plain.toml: no [truth]"));
  EXPECT_FALSE(std::filesystem::exists(path("made")));
}

TEST_F(Simulate, RefusesATruthOfWhatIsNotThere) {
  folder_.file("bad.toml", kProblem + "[truth]\nparameters = { \"squareness.beta\" = 1e-6 }\n");
  const ProgramRun refused = run({"simulate", "bad.toml", "--out", "made"});
  EXPECT_TRUE(is_refused(refused, 2));
  EXPECT_THAT(refused.err, HasSubstr("bad.toml:23: truth.parameters.squareness.beta: unknown key"));
  EXPECT_THAT(refused.err, HasSubstr("accepted: squareness.dbeta_xz"));
  EXPECT_FALSE(std::filesystem::exists(path("made")));
}

TEST_F(Simulate, IntoAFileFails) {
  folder_.file("made", "x");
  const ProgramRun failed = run({"simulate", "problem.toml", "--out", "made"});
  EXPECT_TRUE(is_refused(failed, 1));
  EXPECT_EQ(failed.err, "slideway: made: cannot be made a directory: Not a directory\n");
  EXPECT_EQ(contents(path("made")), "x");
}

}  // namespace
}  // namespace slideway::simulate_test
