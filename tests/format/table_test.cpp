#include "slideway/format/table.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "base/temporary_folder.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"

namespace slideway::table_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::ThrowsMessage;
using Columns = std::vector<std::string>;

class ReadTable : public testing::Test {
 protected:
  Table read(const std::string& text, const Columns& columns = {"1", "2"}) {
    return read_table(folder_.file("t.csv", text), columns);
  }

  // What is wrong with the file, without its path.
  std::string complaint(const std::string& text, const Columns& columns = {"1", "2"}) {
    try {
      read(text, columns);
    } catch (const DataError& error) {
      const std::string path = (folder_.path() / "t.csv").string() + ": ";
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos);
      EXPECT_EQ(message.substr(0, path.size()), path);
      return message.substr(path.size());
    }
    return "no complaint";
  }

  TemporaryFolder folder_;
};

TEST_F(ReadTable, TakesEveryDelimiter) {
  for (const char* text : {"1,2.5\n3,-4\n", "1;2.5\n3;-4\n", "1\t2.5\n3\t-4\n", "1 2.5\n3 -4\n",
                           "  1   2.5 \n 3\t-4\n", "1, 2.5\n3 ,-4 \n", "1,2.5,\n3,-4,\n",
                           "1\t2.5\t\r\n3\t-4\t\r\n", "\"1\",\"2.5\"\n3,\"-4\"\n"}) {
    const Table table = read(text);
    EXPECT_THAT(table.columns, ElementsAre(ElementsAre(1.0, 3.0), ElementsAre(2.5, -4.0))) << text;
  }
}

// Rows after a lone carriage return would be lost without a word.
TEST_F(ReadTable, RefusesACarriageReturnInsideALine) {
  const std::string what =
      ": a carriage return inside the line; accepted: lines that end in CR LF or LF";
  EXPECT_EQ(complaint("1,2\r\n3,4\r5,6\r\n7,8\r\n"), "line 2" + what);
  EXPECT_EQ(complaint("1,2,9\r3,4,9\r5,6,9\r"), "line 1" + what);
  EXPECT_EQ(complaint("x,z\r1,2\r\n3,4\r\n"), "line 1" + what);
  EXPECT_EQ(complaint("1,2\n3,4\n5,6,7\r8,9,1\n"), "line 3" + what);
  EXPECT_THAT(read("1,2\r\r\n3,4\r\r\n").columns[0], ElementsAre(1.0, 3.0));
}

TEST_F(ReadTable, TakesBomCrlfCommentsEmptyLinesAndNoLastNewline) {
  const std::string text =
      "\xef\xbb\xbf# made by hand\r\n\r\n \"x_mm\" , z_um\r\n1,2\r\n  # pause, 7\r\n \t\r\n3,4";
  const Table table = read(text, {"z_um", "x_mm"});
  EXPECT_THAT(table.names, ElementsAre("x_mm", "z_um"));
  EXPECT_THAT(table.columns, ElementsAre(ElementsAre(2.0, 4.0), ElementsAre(1.0, 3.0)));
  EXPECT_EQ(table.sha256, sha256(text));
}

TEST_F(ReadTable, FindsColumnsByNameNumberAndTwice) {
  const std::string text = "t,\"x, along\",z\n0,1,2\n3,4,5\n";
  EXPECT_THAT(read(text, {"x, along"}).columns, ElementsAre(ElementsAre(1.0, 4.0)));
  EXPECT_THAT(read(text, {"3", "t", "z"}).columns,
              ElementsAre(ElementsAre(2.0, 5.0), ElementsAre(0.0, 3.0), ElementsAre(2.0, 5.0)));
  EXPECT_THAT(read("0,1,2\n", {"3"}).names, ElementsAre("1", "2", "3"));
  EXPECT_THAT(read("A title\n0 1 2\n", {"3"}).columns, ElementsAre(ElementsAre(2.0)));
  EXPECT_THAT(read(text, {}).columns, IsEmpty());
}

TEST_F(ReadTable, PassesOverTextInColumnsNobodyAskedFor) {
  const std::string text = "x,note,z\n1,\"drill, small\",2\n3,,4\n5,abc,6\n";
  EXPECT_THAT(read(text, {"x", "z"}).columns,
              ElementsAre(ElementsAre(1.0, 3.0, 5.0), ElementsAre(2.0, 4.0, 6.0)));
}

TEST_F(ReadTable, SplitsTheHeaderAsItsRowsAreSplit) {
  const Table table = read("X (mm)\tslope, urad\n1\t2\n", {"slope, urad"});
  EXPECT_THAT(table.names, ElementsAre("X (mm)", "slope, urad"));
}

TEST_F(ReadTable, SaysWhichFieldIsNoNumber) {
  const std::string head = "x_mm,z_um\n0,0\n";
  const Columns names{"x_mm", "z_um"};
  EXPECT_EQ(complaint(head + "1,abc\n", names), "line 3, column 'z_um': 'abc' is no number");
  EXPECT_EQ(complaint(head + "#\n\n1,\n", names), "line 5: column 'z_um' is empty");
  EXPECT_EQ(complaint("0,0\n1,nan\n"),
            "line 2, column 2: nan is no measured value; remove the row or mask it");
  EXPECT_EQ(complaint("-Inf,0\n1,2\n"),
            "line 1, column 1: -Inf is no measured value; remove the row or mask it");
  EXPECT_EQ(complaint("0,0\n1\n"), "line 2: 1 field, expected at least 2");
  EXPECT_EQ(complaint("0 0 0\n1 1\n", {"3"}), "line 2: 2 fields, expected at least 3");
  EXPECT_EQ(complaint("0,0\n1e,1\n"), "line 2, column 1: '1e' is no number");
  EXPECT_EQ(complaint("0,0\n1.2.3,1\n"), "line 2, column 1: '1.2.3' is no number");
  EXPECT_EQ(complaint("0,0\n1e999,1\n"), "line 2, column 1: '1e999' is no number");
  EXPECT_EQ(complaint("0,0\n1e-999,1\n"), "line 2, column 1: '1e-999' is no number");
  EXPECT_EQ(complaint("0,0\n+-1,1\n"), "line 2, column 1: '+-1' is no number");
  EXPECT_EQ(complaint("0;0\n-1e-999;0,5\n"), "line 2, column 1: '-1e-999' is no number");
  EXPECT_EQ(complaint("0,0\n1 5,1\n"), "line 2, column 1: '1 5' is no number");
}

TEST_F(ReadTable, DoesNotTakeAMistakeInTheFirstRowForAHeader) {
  EXPECT_EQ(complaint("0,abc\n1,2\n"), "line 1, column 2: 'abc' is no number");
  EXPECT_EQ(complaint("0,\n1,2\n"), "line 1: column 2 is empty");
}

TEST_F(ReadTable, ListsTheColumnsThereAre) {
  EXPECT_EQ(complaint("x_mm,z_um\n0,0\n", {"x_mm", "z_mu"}),
            "no column 'z_mu'; the file has: x_mm, z_um (did you mean 'z_um'?)");
  EXPECT_EQ(complaint("0,0\n", {"3"}), "no column '3'; the file has: 1, 2");
  EXPECT_EQ(complaint("0,0\n", {"0"}), "no column '0'; the file has: 1, 2");
  EXPECT_EQ(complaint("x,z,z\n0,0,0\n", {"z"}),
            "has more than one column 'z'; ask for it by its number");
}

TEST_F(ReadTable, RefusesFilesWithoutRows) {
  EXPECT_EQ(complaint(""), "is empty");
  EXPECT_EQ(complaint("# only\n# comments"), "holds no rows of numbers");
  EXPECT_EQ(complaint("\n \r\n\xef\xbb"), "holds no rows of numbers");
  EXPECT_EQ(complaint("\xef\xbb\xbf"), "holds no rows of numbers");
  EXPECT_EQ(complaint("x_mm,z_um\n"), "holds no rows of numbers");
}

TEST_F(ReadTable, RefusesDirectoriesAndMissingFiles) {
  const Columns columns{"1"};
  EXPECT_THROW(read_table(folder_.path(), columns), DataError);
  EXPECT_THROW(read_table(folder_.path() / "none.csv", columns), DataError);
}

TEST_F(ReadTable, RefusesBinaryFilesInOneReadableLine) {
  EXPECT_EQ(complaint("\xff\xfe\x31\n\x31"), "byte 3: half a character of UTF-16");
  EXPECT_EQ(complaint("0,0\n\x01\x02\x1b[31m\xff,1\n"),
            "line 2, column 1: '???[31m?' is no number");
  std::mt19937_64 bits(5);
  for (int file = 0; file < 200; ++file) {
    std::string junk;
    for (int i = 0; i < 500; ++i) junk += static_cast<char>(bits() & 0xffU);
    const std::string message = complaint(junk);
    EXPECT_NE(message, "no complaint");
    EXPECT_LT(message.size(), 1000U);
    for (const char c : message) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20) << message;
  }
}

// strtod of the C library is correctly rounded and, in the C locale of a test, reads the same text.
TEST_F(ReadTable, RoundsEveryValueAsStrtodDoes) {
  std::mt19937_64 bits(11);
  std::vector<std::string> fields{"0",
                                  "-0.0",
                                  "1",
                                  "+1.5",
                                  "00012.500",
                                  ".5",
                                  "5.",
                                  "1E5",
                                  "1e+05",
                                  "1e-5",
                                  "9007199254740992",
                                  "9007199254740993",
                                  "9007199254740993e-1",
                                  "9007199254740992e22",
                                  "9007199254740991e-22",
                                  "1e22",
                                  "1e23",
                                  "1e-22",
                                  "1e-23",
                                  "8.5e23",
                                  "123456789012345678901234567890",
                                  "0.000000000000000000000000000001",
                                  "18446744073709551616",
                                  "9999999999999999999",
                                  "10000000000000000000.5",
                                  "0.1000000000000000055511151231257827",
                                  "2.2250738585072011e-308",
                                  "4.9406564584124654e-324",
                                  "1.7976931348623157e308",
                                  "1e0000000005",
                                  "1e-00000",
                                  "0e0",
                                  "6.631236846766476e-316",
                                  "3.237883913302901e-319",
                                  "7.2057594037927933e16"};
  char text[64];
  while (fields.size() < 100000) {
    const auto any = std::bit_cast<double>(bits());
    if (!std::isfinite(any)) continue;
    std::snprintf(text, sizeof text, "%.17g", any);
    fields.emplace_back(text);
    const double ordinary = std::ldexp(static_cast<double>(bits() >> 11U), -50) - 4.0;
    std::snprintf(text, sizeof text, "%.17g", ordinary);
    fields.emplace_back(text);
    std::snprintf(text, sizeof text, "%.*f", static_cast<int>(bits() % 17), ordinary);
    fields.emplace_back(text);
    std::snprintf(text, sizeof text, "%.*e", static_cast<int>(bits() % 20), ordinary * 1e-6);
    fields.emplace_back(text);
  }
  std::string file;
  for (const std::string& field : fields) file += field + ",7\n";
  const Table table = read(file, {"1"});
  ASSERT_EQ(table.columns[0].size(), fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const double expected = std::strtod(fields[i].c_str(), nullptr);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(table.columns[0][i]),
              std::bit_cast<std::uint64_t>(expected))
        << fields[i];
  }
}

std::vector<double> times_of(const std::string& text, const std::string& column = "1") {
  return parse_table(text, {.columns = {column, "2"}, .clocks = {0}}).columns[0];
}

// 08:29:40 is 8 h + 29 min + 40 s = 30580 s after midnight.
TEST(ClockTimes, AreCountedInSecondsFromTheMidnightBeforeTheFirst) {
  for (const char* text : {"08:29:40,1\n08:29:40.5,2\n", "t,T\n08:29:40,1\n08:29:40.5,2\n",
                           "time;T\n08:29:40,0;1,5\n08:29:40,5;2,5\n",
                           "2026-03-12T08:29:40Z,1\n2026-03-12T08:29:40.5Z,2\n",
                           "2026-03-12 08:29:40;1\n2026-03-12 08:29:40.5;2\n",
                           "12.03.2026 08:29:40;1\n12.03.2026 08:29:40,5;2\n",
                           "2026-03-12T08:29:40+01:00,1\n2026-03-12T08:29:40.5+01:00,2\n"})
    EXPECT_THAT(times_of(text), ElementsAre(30580.0, 30580.5)) << text;
  EXPECT_THAT(times_of("time;T\n08:29;1\n08:30;2\n", "time"), ElementsAre(30540.0, 30600.0));
  const Table table =
      parse_table("t_min,T\n08:29:40,1\n", {.columns = {"t_min", "T"}, .clocks = {0}});
  EXPECT_EQ(table.units[0], "s");
}

TEST(ClockTimes, GoOnOverMidnights) {
  const auto around = ElementsAre(86390.0, 86400.0, 86410.0);
  EXPECT_THAT(times_of("23:59:50,1\n00:00:00,2\n00:00:10,3\n"), around);
  EXPECT_THAT(times_of("2024-02-28T23:59:50,1\n2024-02-29T00:00:00,2\n2024-02-29T00:00:10,3\n"),
              around);
  EXPECT_THAT(times_of("23:59:50,1\n06:00:00,2\n05:59:50,3\n"),
              ElementsAre(86390.0, 108000.0, 107990.0));  // backwards, by less than half a day
}

TEST(ClockTimes, OfTwoFormsInOneColumnAreRefused) {
  for (const char* text :
       {"08:29:40,1\n2026-03-12T08:29:41,2\n", "2026-03-12T08:29:40,1\n08:29:41,2\n",
        "08:29:40Z,1\n09:29:41+01:00,2\n", "2026-03-12T08:29:40Z,1\n2026-03-12T08:29:41,2\n"})
    EXPECT_THAT([&] { times_of(text); },
                ThrowsMessage<DataError>(HasSubstr("line 2: clock times of two forms")))
        << text;
}

TEST(ClockTimes, ThatAreNoneAreRefused) {
  for (const char* field : {"25:00:00", "08:60", "08:29:61", "2026-02-30T08:00", "03/12/2026 08:00",
                            "2026-03-12", "08", "8h", "08:29 AM", "T08:29", "08:29:x"}) {
    const std::string text = std::string("t,T\n08:00:00,1\n") + field + ",2\n";
    EXPECT_THROW(times_of(text, "t"), DataError) << field;
  }
  EXPECT_THROW(parse_table("t,T\n08:29:40,1\n", {.columns = {"t", "T"}}), DataError);
}

}  // namespace
}  // namespace slideway::table_test
