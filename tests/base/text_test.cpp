#include "slideway/base/text.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

using testing::Eq;
using testing::Optional;

TEST(ParseDouble, TakesAWholeFieldWithBlanksAndPlus) {
  EXPECT_THAT(parse_double("1.5"), Optional(1.5));
  EXPECT_THAT(parse_double(" \t+1.5e3 \r"), Optional(1500.0));
  EXPECT_THAT(parse_double("-.5"), Optional(-0.5));
  EXPECT_THAT(parse_double("5."), Optional(5.0));
  EXPECT_TRUE(std::isnan(parse_double("NaN").value()));
  EXPECT_THAT(parse_double("-inf"), Optional(-std::numeric_limits<double>::infinity()));
}

TEST(ParseDouble, RefusesAnythingElse) {
  for (const char* field : {"", " ", "+", "-", ".", "e5", "1e", "1,5", "1 2", "0x10", "1.5mm",
                            "+-1", "++1", "--1", "1e999"})
    EXPECT_EQ(parse_double(field), std::nullopt) << '"' << field << '"';
}

TEST(ParseDouble, RoundsCorrectlyInTheHardCases) {
  // Decimal expansions whose nearest double is known: halfway cases around 2^53, the largest
  // double, the smallest normal and subnormal one.
  EXPECT_THAT(parse_double("9007199254740993"), Optional(9007199254740992.0));
  EXPECT_THAT(parse_double("9007199254740993.00000000000000000001"), Optional(9007199254740994.0));
  EXPECT_THAT(parse_double("1.7976931348623157e308"), Optional(0x1.fffffffffffffp1023));
  EXPECT_THAT(parse_double("2.2250738585072014e-308"), Optional(0x1p-1022));
  EXPECT_THAT(parse_double("2.2250738585072011e-308"), Optional(0x0.fffffffffffffp-1022));
  EXPECT_THAT(parse_double("4.9406564584124654e-324"), Optional(0x1p-1074));
}

TEST(Shortest, ReadsBackAsTheSameDouble) {
  EXPECT_EQ(shortest(0.1), "0.1");
  EXPECT_EQ(shortest(-1.5e-7), "-1.5e-07");
  std::mt19937_64 bits(1);
  for (int i = 0; i < 20000; ++i) {
    const auto value = std::bit_cast<double>(bits());
    if (std::isfinite(value)) {
      EXPECT_THAT(parse_double(shortest(value)), Optional(value));
    }
  }
}

TEST(Significant, AgreesWithPrintf) {
  for (const double value : {0.0, -1.0, 3.14159265, 1e-5, 2.5, 9.995, 1e22, -6.02e-23}) {
    for (const int digits : {2, 3, 6, 17}) {
      char expected[64];
      std::snprintf(expected, sizeof expected, "%.*g", digits, value);
      EXPECT_EQ(significant(value, digits), expected);
    }
  }
}

TEST(Significant, HasNoExponentBelowAMillion) {
  EXPECT_EQ(significant(123456.0, 2), "120000");
  EXPECT_EQ(significant(-258.3, 2), "-260");
  EXPECT_EQ(significant(9.995, 1), "10");
  EXPECT_EQ(significant(1234567.0, 2), "1.2e+06");
}

TEST(Trimmed, TakesBlanksOffBothEndsOnly) {
  EXPECT_EQ(trimmed(" \ta b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \t "), "");
  EXPECT_EQ(trimmed(""), "");
}

TEST(Joined, PutsTheSeparatorBetween) {
  EXPECT_EQ(joined(std::vector<std::string>{}), "");
  EXPECT_EQ(joined(std::vector<std::string>{"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(joined(std::vector<std::string>{"a", "b"}, " + "), "a + b");
}

TEST(Printable, KeepsUtf8AndHidesTheRest) {
  EXPECT_EQ(printable("z_\xc2\xb5m"), "z_\xc2\xb5m");               // micro sign
  EXPECT_EQ(printable("z_\xb5m\x1b[0m\n"), "z_?m?[0m?");            // Latin-1, escape, newline
  EXPECT_EQ(printable("\xed\xa0\x80\xc0\xaf\xe2\x82"), "???????");  // surrogate, overlong, cut off
  EXPECT_EQ(printable("\xe2\x82\xac\xf0\x9f\x98\x80"), "\xe2\x82\xac\xf0\x9f\x98\x80");
  // U+009B (C1 control), U+202E, U+2066 and U+2069 (bidirectional controls)
  EXPECT_EQ(printable("a\xc2\x9b[2J\xe2\x80\xae\xe2\x81\xa6\xe2\x81\xa9z"), "a??[2J?????????z");
  EXPECT_EQ(printable("abcdef", 3), "abc...");
  EXPECT_EQ(printable("abc", 3), "abc");
}

TEST(DidYouMean, FindsTheNearestWordWithinAThirdOfItsLength) {
  const std::vector<std::string> accepted{"x_mm", "z_um", "squareness", "straightness"};
  EXPECT_EQ(did_you_mean("z_mu", accepted), " (did you mean 'z_um'?)");  // one swap
  EXPECT_EQ(did_you_mean("squarness", accepted), " (did you mean 'squareness'?)");
  EXPECT_EQ(did_you_mean("straitnes", accepted), " (did you mean 'straightness'?)");
  EXPECT_EQ(did_you_mean("feed", accepted), "");
  EXPECT_EQ(did_you_mean("", accepted), "");
  EXPECT_EQ(did_you_mean("z", {}), "");
}

TEST(DidYouMean, OverlooksCapitalsButPrefersTheSame) {
  const std::vector<std::string> accepted{"AXIS", "axis", "X_MM"};
  EXPECT_EQ(did_you_mean("axsi", accepted), " (did you mean 'axis'?)");
  EXPECT_EQ(did_you_mean("x_mm", accepted), " (did you mean 'X_MM'?)");
}

TEST(BoundedMessage, IsWholeOrItsTwoEnds) {
  EXPECT_EQ(bounded_message("as it is"), "as it is");
  for (const std::string& word : {std::string(300'000, 'x'), std::string(4, '\n')}) {
    const std::string message = "problem.toml:3: key '" + word + "' is unknown; accepted: name";
    const std::string found = bounded_message(message);
    EXPECT_LE(found.size(), kLongestMessage + 5);
    EXPECT_TRUE(found.starts_with("problem.toml:3: key '"));
    EXPECT_TRUE(found.ends_with("' is unknown; accepted: name"));
    EXPECT_EQ(UsageError(message).what(), found);
  }
}

// No character is cut in two.
TEST(BoundedMessage, IsWholeCharacters) {
  for (std::size_t shift = 0; shift < 3; ++shift) {
    std::string message(shift, 'x');
    for (int i = 0; i < 2000; ++i) message += "µ";
    const std::string found = bounded_message(message);
    const std::size_t gap = found.find(" ... ");
    ASSERT_NE(gap, std::string::npos);
    EXPECT_EQ(found.substr(gap - 2, 2), "µ");
    EXPECT_EQ(found.substr(gap + 5, 2), "µ");
  }
}

}  // namespace
}  // namespace slideway
