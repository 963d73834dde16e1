#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "format/hostile.hpp"

namespace slideway::sdf_test {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::Pointwise;

// The example of NPL's softgauge help page, cut to four heights.
const std::string kNpl =
    "aNPL-V1.0\r\nManuFacID = Softgauges\r\nCreateDate = 210520051200\r\n"
    "ModDate = 210520051200\r\nNumPoints = 4\r\nNumProfiles = 1\r\nXscale = 2.5E-07\r\n"
    "Yscale = 0\r\nZscale = 1E-06\r\nZresolution = -1\r\nCompression = 0\r\nDataType = 7\r\n"
    "CheckType = 0\r\n*\r\n-0.296539\r\n-0.270753\r\n-0.244967\r\n-0.219181\r\n*\r\n*";

const Format& sdf = sdf_format();

TraceRequest line(const std::string& text) { return {.line = text}; }

// A binary file of one row: spacing 1 um, heights in units of 1 nm.
template <typename Number>
std::string binary(char type, const std::vector<Number>& values, std::uint16_t rows = 1) {
  std::string bytes = "bBCR-1.0" + std::string("slideway  ") + std::string(24, '0');
  const auto append = [&](auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);  // the test runs on a little-endian machine
    bytes.append(raw, sizeof value);
  };
  append(static_cast<std::uint16_t>(values.size() / rows));
  append(rows);
  for (const double scale : {1e-6, 2e-6, 1e-9, -1.0}) append(scale);
  bytes += {'\0', type, '\0'};
  for (const Number value : values) append(value);
  return bytes;
}

TEST(Sdf, ReadsTheExampleOfTheStandard) {
  const std::string bytes = sample("surface_format_samples/sdf-1.sdf");
  if (bytes.empty()) GTEST_SKIP() << "no measured data";
  ASSERT_TRUE(sdf.recognises(bytes));
  const Trace row = sdf.read(bytes, line("row:2"));
  EXPECT_EQ(row.position_unit, "m");
  EXPECT_EQ(row.value_unit, "m");
  EXPECT_THAT(row.positions, Pointwise(DoubleEq(), {0.0, 1e-6, 2e-6, 3e-6, 4e-6, 5e-6, 6e-6}));
  EXPECT_THAT(row.values, Pointwise(DoubleEq(), {0.99874e-6, 0.99748e-6, 0.99369e-6, 0.98740e-6,
                                                 0.97862e-6, 0.96736e-6, 0.99874e-6}));
  EXPECT_THAT(sdf.read(bytes, line("column:7")).values,
              Pointwise(DoubleEq(), {1.0e-6, 0.99874e-6, 0.99495e-6, 0.97986e-6}));
  EXPECT_THROW((void)sdf.read(bytes, {}), UsageError);
  expect_every_truncation_refused(sdf, bytes, line("row:1"));
}

TEST(Sdf, ReadsTheProfileOfNpl) {
  ASSERT_TRUE(sdf.recognises(kNpl));
  const Trace trace = sdf.read(kNpl, {});
  EXPECT_THAT(trace.positions, Pointwise(DoubleEq(), {0.0, 2.5e-7, 5e-7, 7.5e-7}));
  EXPECT_THAT(trace.values,
              Pointwise(DoubleEq(), {-0.296539e-6, -0.270753e-6, -0.244967e-6, -0.219181e-6}));
  expect_every_truncation_refused(sdf, kNpl);
}

TEST(Sdf, IsLenientOnVersionAndSpaces) {
  for (const char* version : {"aBCR-1.0", "aISO-1.0", "aBC-1.0", "aBCR - 1.0", "aBCR-0.0"}) {
    const std::string bytes = replaced(kNpl, "aNPL-V1.0", version);
    EXPECT_TRUE(sdf.recognises(bytes)) << version;
    EXPECT_EQ(sdf.read(bytes, {}).values.size(), 4) << version;
  }
  for (const char* spaced : {"NumPoints=4", "NUMPOINTS  =  4", "NumPoints =\r\n4", "NumPoints 4"})
    EXPECT_EQ(sdf.read(replaced(kNpl, "NumPoints = 4", spaced), {}).values.size(), 4) << spaced;
  for (const char* other : {"x,z\n1,2\n", "a-1.0\n", "about-this-file\n", "cISO-1.0\n", "", "a"})
    EXPECT_FALSE(sdf.recognises(other)) << other;
}

TEST(Sdf, KeepsMissingPointsMissing) {
  EXPECT_THAT(sdf.read(replaced(kNpl, "-0.270753", "BAD"), {}).values[1], IsNan());
  EXPECT_THAT(sdf.read(binary<double>(7, {1.0, std::nan("")}), {}).values[1], IsNan());
  EXPECT_THAT(sdf.read(binary<std::uint16_t>(1, {1, 65535}), {}).values[1], IsNan());
  EXPECT_THAT(sdf.read(binary<std::int32_t>(6, {1, INT32_MIN}), {}).values[1], IsNan());
  const Trace trace{{0.0, 1.0, 2.0}, {5.0, std::nan(""), 7.0}, "m", "m", {}};
  const Trace back = sdf.read(sdf.write(trace), {});
  EXPECT_THAT(back.values, ElementsAre(5.0, IsNan(), 7.0));
}

TEST(Sdf, ReadsEveryBinaryType) {
  const auto heights = [](const std::string& bytes) { return sdf.read(bytes, {}).values; };
  EXPECT_THAT(heights(binary<std::uint8_t>(0, {3, 255})), Pointwise(DoubleEq(), {3e-9, 255e-9}));
  EXPECT_THAT(heights(binary<std::uint16_t>(1, {3, 65534})),
              Pointwise(DoubleEq(), {3e-9, 65534e-9}));
  EXPECT_THAT(heights(binary<std::uint32_t>(2, {3, 4294967294})),
              Pointwise(DoubleEq(), {3e-9, 4294967294e-9}));
  EXPECT_THAT(heights(binary<float>(3, {0.5F, -3.0F})), Pointwise(DoubleEq(), {0.5e-9, -3e-9}));
  EXPECT_THAT(heights(binary<std::int8_t>(4, {3, -128})), Pointwise(DoubleEq(), {3e-9, -128e-9}));
  EXPECT_THAT(heights(binary<std::int16_t>(5, {3, -3})), Pointwise(DoubleEq(), {3e-9, -3e-9}));
  EXPECT_THAT(heights(binary<std::int32_t>(6, {3, -3})), Pointwise(DoubleEq(), {3e-9, -3e-9}));
  EXPECT_THAT(heights(binary<double>(7, {0.25, -3.0})), Pointwise(DoubleEq(), {0.25e-9, -3e-9}));
  expect_every_truncation_refused(sdf, binary<std::int16_t>(5, {3, -3, 4}));
}

TEST(Sdf, PassesOverTheLongerHeaderOfSomePrograms) {
  std::string bytes = binary<std::int16_t>(5, {3, -3});
  bytes.insert(81, "\5\0\0\0\1\0\0\0", 8);
  EXPECT_THAT(sdf.read(bytes, {}).values, Pointwise(DoubleEq(), {3e-9, -3e-9}));
  // A trailer is none.
  EXPECT_THAT(sdf.read(binary<std::int16_t>(5, {3, -3}) + "< note >", {}).values,
              Pointwise(DoubleEq(), {3e-9, -3e-9}));
}

TEST(Sdf, TakesLinesOutOfBinaryRows) {
  const std::string bytes = binary<std::int16_t>(5, {1, 2, 3, 4, 5, 6}, 2);
  EXPECT_THAT(sdf.read(bytes, line("row:2")).values, Pointwise(DoubleEq(), {4e-9, 5e-9, 6e-9}));
  const Trace column = sdf.read(bytes, line("column:3"));
  EXPECT_THAT(column.values, Pointwise(DoubleEq(), {3e-9, 6e-9}));
  EXPECT_THAT(column.positions, Pointwise(DoubleEq(), {0.0, 2e-6}));
}

TEST(Sdf, WritesWhatItReads) {
  const Trace trace{
      {0.0, 0.1, 0.2, 0.30000000000000004}, {1.0 / 3.0, -2e-300, 0.0, 5e7}, "m", "m", {}};
  const std::string bytes = sdf.write(trace);
  const Trace back = sdf.read(bytes, {});
  EXPECT_EQ(back.positions, trace.positions);
  EXPECT_EQ(back.values, trace.values);
  EXPECT_EQ(sdf.write(back), bytes);
  expect_every_truncation_refused(sdf, bytes);
}

TEST(Sdf, RefusesToWriteWhatItCanNotHold) {
  EXPECT_THROW((void)sdf.write({{0.0, 1.0, 3.0}, {1, 2, 3}, "mm", "um", {}}), UsageError);
  EXPECT_THROW((void)sdf.write({{1.0, 2.0, 3.0}, {1, 2, 3}, "mm", "um", {}}), UsageError);
  EXPECT_THROW((void)sdf.write({{0.0, 1.0, 2.0}, {1, 2, 3}, "mm", "urad", {}}), UsageError);
  EXPECT_THROW((void)sdf.write({{0.0, 1.0, 2.0}, {1, 2, 3}, "", "um", {}}), UsageError);
  EXPECT_THROW((void)sdf.write({{}, {}, "mm", "um", {}}), UsageError);
}

TEST(Sdf, RefusesHostileFiles) {
  const auto wrong = [&](const std::string& what, const std::string& by) {
    return refusal(sdf, replaced(kNpl, what, by));
  };
  EXPECT_THAT(wrong("NumPoints = 4", "NumPoints = -4"), HasSubstr("NumPoints"));
  EXPECT_THAT(wrong("NumPoints = 4", "NumPoints = 1000000000000000"), HasSubstr("are declared"));
  EXPECT_THAT(wrong("NumPoints = 4", "NumPoints = 1e18"), HasSubstr("NumPoints"));
  EXPECT_THAT(refusal(sdf, replaced(replaced(kNpl, "NumPoints = 4\r\nNumProfiles = 1",
                                             "NumPoints = 1e12 NumProfiles = 1e12"),
                                    "Yscale = 0", "Yscale = 1")),
              HasSubstr("more points than any file holds"));
  EXPECT_THAT(wrong("NumPoints = 4", "NumPoints = 4.5"), HasSubstr("whole number"));
  EXPECT_THAT(wrong("NumPoints = 4", "NumPoints = 3"), HasSubstr("more values than the 3"));
  EXPECT_THAT(wrong("NumPoints = 4\r\n", ""), HasSubstr("NumPoints is missing"));
  EXPECT_THAT(wrong("-0.270753", "-0.27,0753"), HasSubstr("value 2"));
  EXPECT_THAT(wrong("-0.270753", "inf"), HasSubstr("value 2"));
  EXPECT_THAT(wrong("Compression = 0", "Compression = 1"), HasSubstr("Compression"));
  EXPECT_THAT(wrong("DataType = 7", "DataType = 8"), HasSubstr("0 to 7"));
  EXPECT_THAT(wrong("Xscale = 2.5E-07", "Xscale = -1"), HasSubstr("Xscale"));
  EXPECT_THAT(wrong("Xscale = 2.5E-07", "Xscale = 1e999"), HasSubstr("Xscale"));
  EXPECT_THAT(wrong("Zscale = 1E-06", "Zscale = 0"), HasSubstr("Zscale"));
  EXPECT_THAT(wrong("-0.270753", std::string(10'000'000, '7')), HasSubstr("value 2"));
  std::string huge = binary<double>(7, {1.0, 2.0});
  huge.replace(42, 4, "\xff\xff\xff\xff");  // 65535 x 65535 points
  EXPECT_THAT(refusal(sdf, huge), HasSubstr("are declared"));
  huge.replace(42, 2, std::string(2, '\0'));
  EXPECT_THAT(refusal(sdf, huge), HasSubstr("NumPoints"));
}

}  // namespace
}  // namespace slideway::sdf_test
