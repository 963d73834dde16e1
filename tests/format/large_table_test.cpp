#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "slideway/base/error.hpp"
#include "slideway/format/table.hpp"

namespace slideway {
namespace {

constexpr std::size_t kRows = 300'000;  // several chunks of 1 MiB

// Lines of many lengths: signs, exponents, 1 to 19 digits, zeros in front, some with blanks.
std::string number(std::size_t row) {
  static const std::string kDigits = "9007199254740993123";
  std::string text = row % 3 == 0 ? "-" : "";
  text += row % 5 == 0 ? "0.000" : row % 5 == 1 ? "" : "12.";
  text += kDigits.substr(row % 19);
  if (row % 7 == 0) text += "e-" + std::to_string(row % 40);
  return text;
}

std::string text_of(std::size_t rows) {
  std::string text = "x,z\n";
  for (std::size_t i = 0; i < rows; ++i) {
    text +=
        std::to_string(i) + (i % 11 == 0 ? " , " : ",") + number(i) + (i % 13 == 0 ? "\r\n" : "\n");
    if (i % 50'000 == 7) text += "# a comment\n\n";
  }
  return text;
}

const TableRequest kBoth{.columns = {"x", "z"}};

TEST(LargeTable, ReadsEveryRowInOrderAndRoundsAsStrtodDoes) {
  const Table table = parse_table(text_of(kRows), kBoth);
  ASSERT_EQ(table.columns[0].size(), kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    ASSERT_EQ(table.columns[0][i], static_cast<double>(i));
    ASSERT_EQ(table.columns[1][i], std::strtod(number(i).c_str(), nullptr)) << number(i);
  }
}

TEST(LargeTable, NamesTheLineOfTheFirstFault) {
  std::string text = text_of(kRows);  // 1 header line, 2 lines after each of 6 rows
  text += "1,2,3\n";
  text += text_of(kRows).substr(4) + "4,five\n";
  try {
    static_cast<void>(parse_table(text, kBoth));
    FAIL() << "accepted";
  } catch (const DataError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("line 300014: more than 2 fields"))
        << error.what();
  }
}

}  // namespace
}  // namespace slideway
