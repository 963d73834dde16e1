#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

#include "slideway/base/error.hpp"
#include "slideway/format/table.hpp"

namespace slideway::large_table_test {
namespace {

constexpr std::size_t kRows = 300'000;  // several chunks of 256 KiB

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

// As instruments and programs print: 1 to 17 digits, or up to 23 behind the point, of sizes that
// profiles have, or of any.
std::string printed(std::mt19937_64& random) {
  double value =
      std::ldexp(static_cast<double>(random() >> 11U), -53 - static_cast<int>(random() % 24));
  if (random() % 8 == 0) value = std::bit_cast<double>(random());
  if (!(std::abs(value) < 1e307)) value = 0.0;  // printed shorter it is larger
  if (random() % 2 == 0) value = -value;
  const bool fixed = std::abs(value) < 1e6 && random() % 4 != 0;
  std::array<char, 64> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 fixed ? std::chars_format::fixed : std::chars_format::general,
                                 static_cast<int>(fixed ? random() % 24 : 1 + random() % 17));
  return {digits.data(), end.ptr};
}

TEST(LargeTable, RoundsAMillionNumbersAsFromCharsDoes) {
  std::mt19937_64 random(1);
  for (const char* between : {",", " , ", ";"})
    for (const char* ending : {"\n", "\r\n"}) {
      std::vector<std::array<std::string, 2>> rows(90'000);
      std::string text = "x" + std::string(between) + "z" + ending;
      for (auto& row : rows) {
        row = {printed(random), printed(random)};
        text += row[0] + between + row[1] + ending;
      }
      const Table table = parse_table(text, kBoth);
      for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t j = 0; j < 2; ++j) {
          const std::string& number = rows[i][j];
          double expected = 0.0;
          std::from_chars(number.data(), number.data() + number.size(), expected);
          ASSERT_EQ(std::bit_cast<std::uint64_t>(table.columns[j][i]),
                    std::bit_cast<std::uint64_t>(expected))
              << number;
        }
    }
}

// Halfway between two doubles, and next to that: odd m of 54 bits over 2^q are m 5^q of 16 to 20
// digits, q of them behind the point.
TEST(LargeTable, RoundsTiesToEvenAsStrtodDoes) {
  std::mt19937_64 random(3);
  std::vector<std::string> numbers;
  std::string text = "x,z\n";
  for (int i = 0; i < 100'000; ++i) {
    const std::size_t places = random() % 5;
    std::uint64_t digits = (std::uint64_t{1} << 53U) + ((random() >> 11U) | 1U);
    for (std::size_t k = 0; k < places; ++k) digits *= 5;
    std::string number = std::to_string(digits + random() % 3 - 1);
    if (places > 0) number.insert(number.end() - static_cast<std::ptrdiff_t>(places), '.');
    text += number + ",-" + number + "\n";
    numbers.push_back(std::move(number));
  }
  const Table table = parse_table(text, kBoth);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double expected = std::strtod(numbers[i].c_str(), nullptr);
    ASSERT_EQ(table.columns[0][i], expected) << numbers[i];
    ASSERT_EQ(table.columns[1][i], -expected) << numbers[i];
  }
}

TEST(LargeTable, ReadsDecimalCommasAsPoints) {
  std::mt19937_64 random(2);
  std::string points = "x;z\n", commas;
  for (int i = 0; i < 20'000; ++i) points += printed(random) + ";" + printed(random) + "\n";
  for (const char c : points) commas += c == '.' ? ',' : c;
  EXPECT_EQ(parse_table(commas, {.columns = {"x", "z"}, .decimal = ","}).columns,
            parse_table(points, {.columns = {"x", "z"}, .decimal = "."}).columns);
}

TEST(LargeTable, ComesInPartsThatAreTheWhole) {
  const std::string text = text_of(kRows);
  std::vector<std::vector<double>> columns(2);
  double share = 0.0;
  std::size_t parts = 0;
  const Table rest = parse_table(text, kBoth, [&](const TablePart& part) {
    EXPECT_EQ(part.table.names, (std::vector<std::string>{"x", "z"}));
    EXPECT_GT(part.share, share);
    share = part.share;
    ++parts;
    for (std::size_t i = 0; i < 2; ++i)
      columns[i].insert(columns[i].end(), part.columns[i].begin(), part.columns[i].end());
  });
  EXPECT_GT(parts, 10U);
  EXPECT_EQ(share, 1.0);
  EXPECT_TRUE(rest.columns.empty());
  EXPECT_EQ(columns, parse_table(text, kBoth).columns);
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
}  // namespace slideway::large_table_test
