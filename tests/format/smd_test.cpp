#include <gmock/gmock.h>

#include <cmath>

#include "format/hostile.hpp"

namespace slideway::smd_test {
namespace {

using namespace std::string_literals;
using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pointwise;
using testing::SizeIs;

const Format& smd = smd_format();

// The header NPL gives as an example, cut to three heights; sum of the bytes as stated by ISO
// 5436-2.
std::string npl(const std::string& heights = "-0.296539\r\n-0.270753\r\n-0.244967\r\n") {
  std::string text =
      "ISO 5436 - 2000\0 ground01meas\0\r\nPRF\0 1 ISO5436\0\r\n"
      "CX\0 I\0 3 mm\0 1.0e0 D\0 2.5e-4\r\nCZ\0 A\0 3 um\0 1.0e0 D\0\r\n\x03\r\n"
      "DATE 25-Nov-2004\0\r\nTIME 10:57\0\r\nPROFILE_FILTER Gaussian LS 0.0e0 LC 8.0e-1\r\n\x03\r\n"s;
  text += heights + "\x03\r\n";
  unsigned sum = 0;
  for (const char c : text) sum += static_cast<unsigned char>(c);
  return text + std::to_string(sum % 65536) + "\r\n\x03\r\n\x1a";
}

TEST(Smd, ReadsTheHeaderNplGives) {
  const std::string bytes = npl();
  ASSERT_TRUE(smd.recognises(bytes));
  const Trace trace = smd.read(bytes, {});
  EXPECT_EQ(trace.position_unit, "mm");
  EXPECT_EQ(trace.value_unit, "um");
  EXPECT_THAT(trace.positions, Pointwise(DoubleEq(), {0.0, 2.5e-4, 5e-4}));
  EXPECT_THAT(trace.values, ElementsAre(-0.296539, -0.270753, -0.244967));
  expect_every_truncation_refused(smd, bytes);
}

TEST(Smd, MultipliesByTheScale) {
  const TraceRequest lenient{.ignore_checksum = true};
  const std::string bytes =
      replaced(replaced(npl(), "um\0 1.0e0"s, "um\0 1.0e-3"s), "mm\0 1.0e0"s, "mm\0 2"s);
  const Trace trace = smd.read(bytes, lenient);
  EXPECT_THAT(trace.values, Pointwise(DoubleEq(), {-0.296539e-3, -0.270753e-3, -0.244967e-3}));
  EXPECT_THAT(trace.positions, Pointwise(DoubleEq(), {0.0, 5e-4, 10e-4}));
}

TEST(Smd, WritesWhatItReads) {
  const Trace trace{
      {0.0, 0.1, 0.2, 0.30000000000000004}, {1.0 / 3.0, -2e-300, 0.0, 5e7}, "mm", "nm", {}};
  const std::string bytes = smd.write(trace);
  const Trace back = smd.read(bytes, {});
  EXPECT_EQ(back.positions, trace.positions);
  EXPECT_EQ(back.values, trace.values);
  EXPECT_EQ(back.position_unit, "mm");
  EXPECT_EQ(back.value_unit, "nm");
  EXPECT_EQ(smd.write(back), bytes);
  expect_every_truncation_refused(smd, bytes);
  EXPECT_THROW((void)smd.write({{0.0, 1.0}, {1.0, std::nan("")}, "mm", "um", {}}), UsageError);
  EXPECT_THROW((void)smd.write({{0.0, 1.0}, {1.0, 2.0}, "mm", "urad", {}}), UsageError);
  EXPECT_THROW((void)smd.write({{3.0, 1.0}, {1.0, 2.0}, "mm", "um", {}}), UsageError);
}

TEST(Smd, VerifiesTheChecksum) {
  const std::string bytes = replaced(npl(), "0.296539", "0.296538");
  EXPECT_THAT(refusal(smd, bytes), HasSubstr("checksum"));
  const Trace trace = smd.read(bytes, {.ignore_checksum = true});
  EXPECT_EQ(trace.values[0], -0.296538);
  EXPECT_THAT(trace.decisions, ElementsAre(HasSubstr("checksum")));
}

TEST(Smd, RefusesHostileFiles) {
  const auto wrong = [&](const std::string& what, const std::string& by) {
    return refusal(smd, replaced(npl(), what, by), {.ignore_checksum = true});
  };
  EXPECT_THAT(wrong("CX\0 I\0 3"s, "CX\0 I\0 -3"s), HasSubstr("count"));
  EXPECT_THAT(wrong("CX\0 I\0 3"s, "CX\0 I\0 4"s), HasSubstr("CX has 4 points, CZ 3"));
  EXPECT_THAT(refusal(smd,
                      replaced(replaced(npl(), "I\0 3"s, "I\0 1000000000000000"s), "A\0 3"s,
                               "A\0 1000000000000000"s),
                      {.ignore_checksum = true}),
              HasSubstr("are declared"));
  EXPECT_THAT(wrong("CX\0 I"s, "CX\0 A"s), HasSubstr("axis type 'A'"));
  EXPECT_THAT(wrong("PRF\0"s, "SUR\0"s), HasSubstr("feature type 'SUR'"));
  EXPECT_THAT(wrong("mm\0"s, "furlong\0"s), HasSubstr("furlong"));
  EXPECT_THAT(wrong("2.5e-4", "0"), HasSubstr("increment"));
  EXPECT_THAT(refusal(smd, replaced(npl("1\r\n1e308\r\n1\r\n"), "um\0 1.0e0"s, "um\0 10"s),
                      {.ignore_checksum = true}),
              HasSubstr("CZ, scale: 10; accepted: one that leaves heights finite"));
  EXPECT_THAT(wrong("2.5e-4", "1e308"), HasSubstr("leaves positions finite"));
  EXPECT_THAT(wrong("2.5e-4", ""), HasSubstr("CX"));
  EXPECT_THAT(wrong("-0.270753", "abc"), HasSubstr("value 2"));
  EXPECT_THAT(wrong("-0.270753", "nan"), HasSubstr("value 2"));
  EXPECT_THAT(wrong("-0.270753\r\n", ""), HasSubstr("2 values where 3"));
  EXPECT_THAT(wrong("CX\0"s, std::string(10'000'000, 'x')), HasSubstr("CX"));
  EXPECT_THROW((void)smd.read(npl(), {.line = "row:1"}), UsageError);
}

}  // namespace
}  // namespace slideway::smd_test
