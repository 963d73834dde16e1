#include "slideway/report/number.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace slideway::number_test {
namespace {

using testing::AllOf;
using testing::Field;

auto pair_of(const std::string& value, const std::string& uncertainty) {
  return AllOf(Field(&RoundedPair::value, value), Field(&RoundedPair::uncertainty, uncertainty));
}

// JCGM 100:2008, 7.2.6: "if y = 10,057 62 Ω with u_c(y) = 27 mΩ, y should be rounded to 10,058 Ω".
TEST(Rounded, GivesTheExampleOfGum726) {
  EXPECT_THAT(rounded(10.05762, 0.027), pair_of("10.058", "0.027"));
}

// JCGM 100:2008, 7.2.2 and 7.2.4: m_S = 100,021 47 g with u_c = 0,35 mg; U = 0,79 mg.
TEST(Rounded, GivesTheMassStandardOfGum72) {
  EXPECT_THAT(rounded(100.02147, 0.00035), pair_of("100.02147", "0.00035"));
  EXPECT_THAT(rounded(100.02147, 0.00079), pair_of("100.02147", "0.00079"));
}

TEST(Rounded, MovesThePlaceWhenTheUncertaintyRoundsUpToTheNextPower) {
  EXPECT_THAT(rounded(123.456, 9.96), pair_of("123", "10"));
  EXPECT_THAT(rounded(1.23456, 0.0996), pair_of("1.23", "0.10"));
  EXPECT_THAT(rounded(1.23456, 0.0994), pair_of("1.235", "0.099"));
}

TEST(Rounded, ClearsTheDigitsBeforeThePointThatAreNotKnown) {
  EXPECT_THAT(rounded(56789.0, 1234.0), pair_of("56800", "1200"));
  EXPECT_THAT(rounded(-449.0, 1234.0), pair_of("-400", "1200"));
}

TEST(Rounded, KeepsTrailingZerosThatAreKnown) {
  EXPECT_THAT(rounded(2.8, 0.0022), pair_of("2.8000", "0.0022"));
  EXPECT_THAT(rounded(0.0, 0.5), pair_of("0.00", "0.50"));
}

TEST(Rounded, NeverWritesMinusZero) {
  EXPECT_THAT(rounded(-0.001, 0.5), pair_of("0.00", "0.50"));
  EXPECT_THAT(rounded(-4.0, 1234.0), pair_of("0", "1200"));
}

TEST(Rounded, WritesAnExactValueInFull) { EXPECT_THAT(rounded(0.1, 0.0), pair_of("0.1", "0")); }

TEST(Rounded, ShowsAValueFarBelowItsUncertaintyAsZero) {
  EXPECT_THAT(rounded(3e-12, 4.0), pair_of("0.0", "4.0"));
  EXPECT_EQ(with_uncertainty(-1e-29, 2e-12), "(0.0 ± 2.0)e-12");
  EXPECT_EQ(with_uncertainty(2.5e-32, 9.9e-15), "(0.0 ± 9.9)e-15");
  EXPECT_THAT(rounded(0.0, 1e-300).value, testing::MatchesRegex("0[.]0*"));
}

TEST(Rounded, WritesTwelveDigitsWhereTheUncertaintyLiesBeyond) {
  EXPECT_THAT(rounded(1e300, 1e-300), pair_of("1e+300", "1.0e-300"));
  EXPECT_THAT(rounded(1.0, std::numeric_limits<double>::denorm_min()), pair_of("1", "4.9e-324"));
  EXPECT_THAT(rounded(2.287254867310929e-34, 0.0), pair_of("2.28725486731e-34", "0"));
  EXPECT_EQ(with_uncertainty(0.006321875, 2.5e-14), "0.006321875 ± 2.5e-14");
}

TEST(Rounded, RefusesWhatIsNoUncertainty) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(rounded(nan, 1.0), std::logic_error);
  EXPECT_THROW(rounded(1.0, nan), std::logic_error);
  EXPECT_THROW(rounded(1.0, std::numeric_limits<double>::infinity()), std::logic_error);
  EXPECT_THROW(rounded(1.0, -0.1), std::logic_error);
}

TEST(WithUncertainty, SharesOnePowerOfTenWhereTheValueIsSmallOrLarge) {
  EXPECT_EQ(with_uncertainty(2.8e-6, 2.2e-9), "(2.8000 ± 0.0022)e-06");
  EXPECT_EQ(with_uncertainty(-2.29e-8, 2e-10), "(-2.290 ± 0.020)e-08");
  EXPECT_EQ(with_uncertainty(1.25e7, 3e5), "(1.250 ± 0.030)e+07");
  EXPECT_EQ(with_uncertainty(1e-9, 2.5e-6), "(0.0 ± 2.5)e-06");
}

TEST(WithUncertainty, StaysPlainInBetween) {
  EXPECT_EQ(with_uncertainty(10.05762, 0.027), "10.058 ± 0.027");
  EXPECT_EQ(with_uncertainty(1e-6, 0.5), "0.00 ± 0.50");
  EXPECT_EQ(with_uncertainty(0.0, 0.0), "0 ± 0");
}

TEST(WithUncertainty, CarriesIntoTheNextPowerInsteadOfWritingTen) {
  EXPECT_EQ(with_uncertainty(9.9999e-6, 1e-7), "(1.000 ± 0.010)e-05");
}

TEST(FixedPoint, RoundsAndNeverWritesMinusZero) {
  EXPECT_EQ(fixed_point(0.99996, 4), "1.0000");
  EXPECT_EQ(fixed_point(-0.00001, 2), "0.00");
  EXPECT_EQ(fixed_point(1234.5678, 0), "1235");
}

TEST(ToDigits, CountsInPlainDecimals) {
  EXPECT_EQ(to_digits(1888.0, 3), "1890");
  EXPECT_EQ(to_digits(-999.6, 3), "-1000");
  EXPECT_EQ(to_digits(0.00123456, 3), "0.00123");
  EXPECT_EQ(to_digits(12.3456, 4), "12.35");
  EXPECT_EQ(to_digits(5.3e6, 2), "5.3e+06");
  EXPECT_EQ(to_digits(0.0, 3), "0");
  EXPECT_THROW(to_digits(std::numeric_limits<double>::infinity(), 3), std::logic_error);
}

}  // namespace
}  // namespace slideway::number_test
