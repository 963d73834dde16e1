#include <gmock/gmock.h>

#include <cmath>

#include "format/hostile.hpp"

namespace slideway::prf_test {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;

const Format& prf = prf_format();

// The example of NPL's softgauge help page, cut to three heights.
const std::string kNpl =
    "1 2\r\nSG2004 0.000000e+000 PRF\r\nCX M 3.000000e+000 MM 1.000000e+000 D\r\n"
    "CZ M 3.000000e+000 UM 1.000000e-006 L\r\nEOR\r\nSTYLUS_RADIUS 0.000000e+000 MM\r\n"
    "SPACING CX 2.500000e-004\r\nMAP 1.000000e+000 CZ CZ 1.000000e+000 1.000000e+000\r\n"
    "MAP 2.000000e+000 CZ CX 1.000000e+000 0.000000e+000\r\nEOR\r\n"
    "-296539\r\n-270753\r\n-244967\r\nEOR\r\nEOF";

TEST(Prf, ReadsTheExampleOfNpl) {
  ASSERT_TRUE(prf.recognises(kNpl));
  const Trace trace = prf.read(kNpl, {});
  EXPECT_EQ(trace.position_unit, "mm");
  EXPECT_EQ(trace.value_unit, "um");
  EXPECT_THAT(trace.positions, Pointwise(DoubleEq(), {0.0, 2.5e-4, 5e-4}));
  // The same profile's SDF and SMD files say -0.296539 um.
  EXPECT_THAT(trace.values, Pointwise(DoubleEq(), {-0.296539, -0.270753, -0.244967}));
  expect_every_truncation_refused(prf, kNpl);
}

TEST(Prf, IsToldFromTwoColumnsOfNumbers) {
  EXPECT_FALSE(prf.recognises("1 2\n3 4\n"));
  EXPECT_FALSE(prf.recognises("1 2"));
  EXPECT_FALSE(prf.recognises(""));
}

TEST(Prf, WritesWhatItReads) {
  const Trace trace{
      {0.0, 0.1, 0.2, 0.30000000000000004}, {1.0 / 3.0, -2e-300, 0.0, 5e7}, "mm", "um", {}};
  const std::string bytes = prf.write(trace);
  const Trace back = prf.read(bytes, {});
  EXPECT_EQ(back.positions, trace.positions);
  EXPECT_EQ(back.values, trace.values);
  EXPECT_EQ(back.position_unit, "mm");
  EXPECT_EQ(back.value_unit, "um");
  EXPECT_EQ(prf.write(back), bytes);
  expect_every_truncation_refused(prf, bytes);
  EXPECT_THROW((void)prf.write({{0.0, 1.0}, {1.0, std::nan("")}, "mm", "um", {}}), UsageError);
  EXPECT_THROW((void)prf.write({{0.0, 1.0}, {1.0, 2.0}, "mm", "arcsec", {}}), UsageError);
}

TEST(Prf, WritesInchesAsMillimetres) {
  const Trace back = prf.read(prf.write({{0.0, 1.0}, {2.0, 3.0}, "inch", "inch", {}}), {});
  EXPECT_EQ(back.value_unit, "mm");
  EXPECT_THAT(back.positions, Pointwise(DoubleEq(), {0.0, 25.4}));
  EXPECT_THAT(back.values, Pointwise(DoubleEq(), {50.8, 76.2}));
}

TEST(Prf, RefusesHostileFiles) {
  const auto wrong = [&](const std::string& what, const std::string& by) {
    return refusal(prf, replaced(kNpl, what, by));
  };
  EXPECT_THAT(wrong("CX M 3.000000e+000", "CX M -3"), HasSubstr("count"));
  EXPECT_THAT(wrong("CX M 3.000000e+000", "CX M 3.5"), HasSubstr("count"));
  EXPECT_THAT(wrong("CX M 3.000000e+000", "CX M 1e18"), HasSubstr("count"));
  EXPECT_THAT(wrong("CX M 3.000000e+000", "CX M 5"), HasSubstr("CX has 5 points, CZ 3"));
  EXPECT_THAT(refusal(prf, replaced(replaced(kNpl, "CX M 3.000000e+000", "CX M 1e15"),
                                    "CZ M 3.000000e+000", "CZ M 1e15")),
              HasSubstr("are declared"));
  EXPECT_THAT(wrong("UM", "YARD"), HasSubstr("YARD"));
  EXPECT_THAT(wrong("1.000000e-006", "0"), HasSubstr("scale"));
  EXPECT_THAT(wrong("1.000000e-006", "1e308"), HasSubstr("leaves heights finite"));
  EXPECT_THAT(wrong("SPACING CX", "PACING CX"), HasSubstr("SPACING CX is missing"));
  EXPECT_THAT(wrong("2.500000e-004", "-1"), HasSubstr("SPACING"));
  EXPECT_THAT(wrong("-270753", "12x"), HasSubstr("value 2"));
  EXPECT_THAT(wrong("-270753", ""), HasSubstr("2 values where 3"));
  EXPECT_THAT(wrong("CZ M", std::string(10'000'000, '9')), HasSubstr("CZ"));
  EXPECT_THROW((void)prf.read(kNpl, {.line = "row:1"}), UsageError);
}

}  // namespace
}  // namespace slideway::prf_test
