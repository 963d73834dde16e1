#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli/bad_input.hpp"

namespace slideway::rank_test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kColumns = shipped("data/axis-ranking.csv");

class Rank : public ProgramTest {
 protected:
  [[nodiscard]] json ranking(std::vector<std::string> more) const {
    more.insert(more.begin(), {"rank", kColumns, "--signal", "measured", "--json", "-"});
    more.insert(more.end(), {"--candidates", "error_x", "error_y", "error_z"});
    const ProgramRun done = run(more);
    EXPECT_EQ(done.exit_code, 0) << done.err;
    return json::parse(done.out)["ranking"];
  }
};

// Correlation coefficients after their definition, by a script in Python on the same file; low
// band: of the means of 32 samples, which is what db1 at level 5 is but for a factor.
struct Expected {
  std::string candidate;
  double raw, low_band;
};
const std::vector<Expected> kExpected{{"error_y", 0.9127229492047106, 0.9861723188830749},
                                      {"error_x", 0.7888939155207357, 0.8547927409791803},
                                      {"error_z", 0.06301149336733344, 0.06304165563424682}};

TEST_F(Rank, PutsTheAxesOfAFileInTheOrderOfFig11) {
  const json rows = ranking({"--level", "5"});
  ASSERT_EQ(rows.size(), kExpected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i]["candidate"], kExpected[i].candidate);
    // 2048 terms of rounding 1e-16 each
    EXPECT_NEAR(rows[i]["raw"].get<double>(), kExpected[i].raw, 1e-12);
    EXPECT_NEAR(rows[i]["low_band"].get<double>(), kExpected[i].low_band, 1e-12);
  }
}

TEST_F(Rank, WithoutALowBandHasOneCoefficient) {
  for (const json& row : ranking({})) EXPECT_EQ(row["raw"], row["low_band"]);
  const ProgramRun done =
      run({"rank", kColumns, "--signal", "measured", "--candidates", "error_z"});
  EXPECT_THAT(done.out, testing::Not(HasSubstr("low band")));
}

TEST_F(Rank, OfAFileWhoseNameIsNoTextIsADocument) {
  folder_.file("\xff.csv", contents(kColumns));
  const ProgramRun done =
      run({"rank", "\xff.csv", "--signal", "measured", "--candidates", "error_x", "--json", "-"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(json::parse(done.out)["file"], "\uFFFD.csv");
}

TEST_F(Rank, PrintsTheColumnsOfAFileInOrder) {
  const ProgramRun done = run({"rank", kColumns, "--level", "5", "--signal", "measured",
                               "--candidates", "error_z", "error_x", "error_y"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_THAT(done.out,
              testing::ContainsRegex("error_y +0\\.913 +0\\.986[^\n]*\n +error_x +0\\.789 "
                                     "+0\\.855[^\n]*\n +error_z +0\\.063 +0\\.063"));
}

TEST_F(Rank, TakesColumnsByNumber) {
  const ProgramRun by_number =
      run({"rank", kColumns, "--signal", "2", "--candidates", "4", "5", "--json", "-"});
  EXPECT_EQ(by_number.exit_code, 0) << by_number.err;
  const json rows = json::parse(by_number.out)["ranking"];
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(rows[0]["raw"].get<double>(), kExpected[0].raw, 1e-12);
}

TEST_F(Rank, OfAProblemListsEveryEffectOnEveryProfile) {
  const ProgramRun done =
      run({"rank", shipped("problems/paper-600mm/problem.toml"), "--json", "-"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  const json report = json::parse(done.out);
  std::vector<std::string> pairs;
  for (const json& row : report["ranking"])
    pairs.push_back(row["effect"].get<std::string>() + " " + row["profile"].get<std::string>());
  EXPECT_THAT(pairs, testing::UnorderedElementsAre("straightness feed2", "squareness feed2",
                                                   "straightness feed8", "squareness feed8"));
  EXPECT_EQ(report["dominant"]["by_correlation"], "squareness");
  EXPECT_TRUE(report["declared"].is_null());
  EXPECT_TRUE(report["final"].is_null());
}

TEST_F(Rank, GivesTheSameBytesASecondTime) {
  const std::vector<std::string> arguments{"rank", kColumns, "--signal", "2", "--candidates", "3"};
  EXPECT_EQ(run(arguments).out, run(arguments).out);
}

TEST_F(Rank, RefusesBadDataInOneLine) {
  folder_.file("face.csv", face_csv(64, 30, "30,abc"));
  folder_.file("empty.csv", "");
  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "rank");
    arguments.insert(arguments.end(), {"--json", "report.json"});
    const ProgramRun refused = run(arguments);
    EXPECT_TRUE(is_refused(refused, 3));
    return refused.err;
  };
  EXPECT_THAT(refusal({kColumns, "--signal", "mesured", "--candidates", "error_x"}),
              testing::AllOf(HasSubstr("axis-ranking.csv: no column 'mesured'"),
                             HasSubstr("did you mean 'measured'?")));
  EXPECT_THAT(refusal({kColumns, "--signal", "measured", "--candidates", "error_x", "eror_y"}),
              HasSubstr("no column 'eror_y'"));
  EXPECT_THAT(refusal({kColumns, "--level", "12", "--signal", "2", "--candidates", "3"}),
              testing::AllOf(HasSubstr("axis-ranking.csv: "), HasSubstr("2048 samples"),
                             HasSubstr("accepted: level <= 11")));
  EXPECT_THAT(refusal({"face.csv", "--signal", "1", "--candidates", "2"}),
              HasSubstr("face.csv: line 32, column 'z_um': 'abc' is no number"));
  EXPECT_THAT(refusal({"empty.csv", "--signal", "1", "--candidates", "2"}),
              HasSubstr("empty.csv: is empty"));
  EXPECT_THAT(refusal({"gone.csv", "--signal", "1", "--candidates", "2"}),
              HasSubstr("gone.csv: cannot be read"));
  EXPECT_THAT(refusal({".", "--signal", "1", "--candidates", "2"}), HasSubstr("is a directory"));
  EXPECT_THAT(names_in(folder_.path()), ElementsAre("empty.csv", "face.csv"));
}

}  // namespace
}  // namespace slideway::rank_test
