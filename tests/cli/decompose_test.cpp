#include <gmock/gmock.h>

#include <array>
#include <cmath>

#include "cli/bad_input.hpp"
#include "slideway/format/table.hpp"

namespace slideway::decompose_test {
namespace {

using testing::HasSubstr;

const std::string kColumns = shipped("data/axis-ranking.csv");

class Decompose : public ProgramTest {};

std::vector<std::string> columns_of_level(int level) {
  std::vector<std::string> names{"position_mm", "signal"};
  for (const char* band : {"a", "d"})
    for (int j = 1; j <= level; ++j) names.push_back(band + std::to_string(j));
  return names;
}

TEST_F(Decompose, WritesBandsOfFullLengthThatAddUpToTheSignal) {
  const std::array<std::string, 2> signal{"position_mm", "measured"};
  const Table given = read_table(kColumns, signal);
  for (const char* boundary : {"symmetric", "periodization", "zero", "smooth"}) {
    for (const auto& [wavelet, level] : {std::pair<std::string, int>{"db1", 3}, {"db4", 5}}) {
      const ProgramRun done =
          run({"decompose", kColumns, "--wavelet", wavelet, "--level", std::to_string(level),
               "--boundary", boundary, "--out", "bands.csv"});
      ASSERT_EQ(done.exit_code, 0) << done.err;
      EXPECT_EQ(done.out + done.err, "");
      const std::vector<std::string> names = columns_of_level(level);
      const Table bands = read_table(path("bands.csv"), names);
      EXPECT_EQ(bands.names, names);
      ASSERT_EQ(bands.columns[0], given.columns[0]);
      ASSERT_EQ(bands.columns[1], given.columns[1]);
      double largest = 0.0, size = 0.0;
      for (std::size_t i = 0; i < bands.columns[1].size(); ++i) {
        double sum = bands.columns[1 + level][i];
        for (int j = 1; j <= level; ++j) sum += bands.columns[1 + level + j][i];
        largest = std::max(largest, std::abs(sum - bands.columns[1][i]));
        size = std::max(size, std::abs(bands.columns[1][i]));
      }
      EXPECT_LE(largest, 1e-12 * size) << wavelet << " " << boundary;  // a level rounds by 1e-15
    }
  }
}

TEST_F(Decompose, TakesTheHaarBandFromMeansOfPairs) {
  folder_.file("pairs.csv", "1,3\n2,5\n3,-1\n4,2\n");
  const ProgramRun done =
      run({"decompose", "pairs.csv", "--wavelet", "db1", "--level", "1", "--out", "-"});
  EXPECT_EQ(done.exit_code, 0) << done.err;
  folder_.file("bands.csv", done.out);
  const Table bands = read_table(path("bands.csv"), columns_of_level(1));
  const std::vector<double> means{4.0, 4.0, 0.5, 0.5};
  for (std::size_t i = 0; i < means.size(); ++i)  // products with sqrt(1/2), rounded
    EXPECT_NEAR(bands.columns[2][i], means[i], 1e-14);
}

TEST_F(Decompose, WritesTheSameToStdoutAsToAFile) {
  const ProgramRun printed = run({"decompose", kColumns, "--out", "-"});
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_EQ(run({"decompose", kColumns, "--out", "bands.csv"}).exit_code, 0);
  EXPECT_EQ(printed.out, contents(path("bands.csv")));
  EXPECT_THAT(printed.out,
              testing::StartsWith("position_mm,signal,a1,a2,a3,a4,a5,d1,d2,d3,d4,d5\n"));
}

TEST_F(Decompose, TakesColumnsByNameOrNumber) {
  const std::string by_name = run({"decompose", kColumns, "--value", "error_z", "--out", "-"}).out;
  EXPECT_EQ(run({"decompose", kColumns, "--value", "5", "--out", "-"}).out, by_name);
  EXPECT_NE(run({"decompose", kColumns, "--out", "-"}).out, by_name);
}

TEST_F(Decompose, SaysThatPositionsAreNotEvenlySpaced) {
  folder_.file("face.csv", face_csv(64, 30, "30.4,0.1"));
  const ProgramRun done = run({"decompose", "face.csv", "--level", "2", "--out", "o.csv"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_EQ(lines_of(done.err).size(), 1U);
  EXPECT_THAT(done.err, HasSubstr("face.csv: positions are not evenly spaced"));
}

TEST_F(Decompose, RefusesBadDataInOneLine) {
  folder_.file("face.csv", face_csv(20));
  folder_.file("nan.csv", face_csv(64, 30, "30,nan"));
  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "decompose");
    arguments.insert(arguments.end(), {"--out", "bands.csv"});
    const ProgramRun refused = run(arguments);
    EXPECT_TRUE(is_refused(refused, 3));
    return refused.err;
  };
  EXPECT_THAT(refusal({"face.csv"}), HasSubstr("face.csv: 20 rows; --level 5 needs 32"));
  EXPECT_THAT(refusal({"nan.csv"}), HasSubstr("nan.csv: data row 31: the value is missing"));
  EXPECT_THAT(refusal({"face.csv", "--value", "z"}), HasSubstr("face.csv: no column 'z'"));
  EXPECT_THAT(refusal({"gone.csv"}), HasSubstr("gone.csv: cannot be read"));
  EXPECT_THAT(refusal({"."}), HasSubstr(".: is a directory"));
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("face.csv", "nan.csv"));
}

}  // namespace
}  // namespace slideway::decompose_test
