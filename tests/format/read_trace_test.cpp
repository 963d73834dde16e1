#include <gmock/gmock.h>

#include "base/temporary_folder.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/format/format.hpp"
#include "support/measured_data.hpp"

namespace slideway::read_trace_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

class ReadTrace : public testing::Test {
 protected:
  TraceFile read(const std::string& text, const TraceRequest& request = {}) {
    return read_trace(folder_.file("face.csv", text), request);
  }
  std::string path() { return (folder_.path() / "face.csv").string(); }
  TemporaryFolder folder_;
};

TEST_F(ReadTrace, TellsFormatUnitsDecisionsAndHash) {
  const std::string text = "t;x [mm];H\xf6he [\xb5m]\n9;0,5;1,5\n9;1;\n";
  const TraceFile file = read(text, {.position_column = "x [mm]", .value_column = "3"});
  EXPECT_EQ(file.format, "text");
  EXPECT_FALSE(file.states_units);
  EXPECT_EQ(file.sha256, sha256(text));
  EXPECT_EQ(file.trace.position_unit, "mm");
  EXPECT_EQ(file.trace.value_unit, "um");
  EXPECT_THAT(file.trace.positions, ElementsAre(0.5, 1.0));
  EXPECT_THAT(file.trace.decisions,
              ElementsAre("Latin-1, semicolons between columns, decimal comma, 1 header line, "
                          "columns x [mm] and Höhe [µm] of 3",
                          "1 value is missing: empty, nan, na or null"));
}

TEST_F(ReadTrace, PutsThePathInFrontOfWhatIsWrong) {
  EXPECT_THAT([&] { read("0,1\n1,abc\n"); },
              ThrowsMessage<DataError>(StartsWith(path() + ": line 2, column 2: 'abc'")));
  EXPECT_THAT([&] { read(""); }, ThrowsMessage<DataError>(path() + ": is empty"));
  EXPECT_THAT([&] { read("0,1\n", {.line = "row:1"}); },
              ThrowsMessage<UsageError>(StartsWith(path() + ": line = \"row:1\" belongs to an")));
}

// What makes a naive reader eat memory or time; each is refused or read, quickly and in one line.
TEST_F(ReadTrace, StandsHostileText) {
  constexpr std::size_t kMany = 8'000'000;
  for (const std::string& text :
       {std::string(kMany, ','), std::string(kMany, '\n'), std::string(kMany, '1'),
        std::string(kMany, '"'), std::string(kMany, '\0'), "x,z\n0,1\n" + std::string(kMany, ','),
        "x,z\n0,1\n1," + std::string(kMany, '"'), "0,1\n1," + std::string(kMany, '9') + "x\n",
        "\xff\xfe" + std::string(kMany, 'a'), std::string(kMany, '#')}) {
    try {
      read(text);
      FAIL() << "was read";
    } catch (const DataError& error) {
      EXPECT_LT(std::string(error.what()).size(), 1000U);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
}

std::filesystem::path sample(const std::string& name) {
  return measured_data() / "surface_format_samples" / name;
}

// Lengths, steps and units as SOURCE.md and the files' own headers tell them.
TEST(TextSamples, AreReadAsTheirInstrumentsWroteThem) {
  if (!std::filesystem::exists(sample("dektak-1.csv"))) GTEST_SKIP() << "no SLIDEWAY_DATA";
  const Trace dektak = read_trace(sample("dektak-1.csv"), {}).trace;
  EXPECT_EQ(dektak.position_unit, "um");
  EXPECT_EQ(dektak.value_unit, "um");
  EXPECT_NEAR(dektak.positions.back() - dektak.positions.front(), 1500.0,
              0.25);  // one step, rounded to 0.1
  EXPECT_NEAR(dektak.positions.back() / static_cast<double>(dektak.positions.size() - 1), 0.156,
              5e-4);

  const Trace contour = read_trace(sample("hfm-1.hfm"), {}).trace;
  EXPECT_EQ(contour.position_unit, "mm");
  EXPECT_EQ(contour.value_unit, "mm");
  EXPECT_NEAR(contour.positions[1] - contour.positions[0], 5e-4, 1e-9);

  const TraceFile line = read_trace(sample("opdx-3.txt"), {});
  EXPECT_EQ(line.trace.position_unit, "");  // two bare columns: metres, but only SOURCE.md says so
  EXPECT_THAT(line.trace.decisions, ElementsAre(HasSubstr("no header")));
}

}  // namespace
}  // namespace slideway::read_trace_test
