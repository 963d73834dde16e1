#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "slideway/base/error.hpp"
#include "slideway/base/units.hpp"
#include "slideway/format/format.hpp"

namespace slideway::contract_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// What every format can hold: even steps, lengths. Heights and steps are multiples of powers of two
// in the unit, so that scaling by ten costs at most one rounding.
Trace sample() {
  Trace trace{{}, {}, "mm", "um", {}};
  for (int i = 0; i < 12; ++i) {
    trace.positions.push_back(0.5 * i);
    trace.values.push_back(0.25 * ((i * 7) % 12) - 1.5);
  }
  return trace;
}

double in_mm(double value, const std::string& unit) {
  const auto scale = length_unit(unit);
  if (!scale) throw std::logic_error("no length: " + unit);
  return (*scale)(value);
}

// A step, a multiple of it and two changes of unit: four roundings of 1.1e-16.
constexpr double kRounding = 5e-16;

// Equal as lengths.
void expect_same(const Trace& given, const Trace& expected) {
  ASSERT_EQ(given.positions.size(), expected.positions.size());
  ASSERT_EQ(given.values.size(), expected.values.size());
  for (std::size_t i = 0; i < expected.positions.size(); ++i) {
    const double position = in_mm(expected.positions[i], expected.position_unit);
    EXPECT_NEAR(in_mm(given.positions[i], given.position_unit), position,
                kRounding * std::abs(position))
        << i;
    if (std::isnan(expected.values[i])) {
      EXPECT_TRUE(std::isnan(given.values[i])) << i;
      continue;
    }
    const double value = in_mm(expected.values[i], expected.value_unit);
    EXPECT_NEAR(in_mm(given.values[i], given.value_unit), value, kRounding * std::abs(value)) << i;
  }
}

class FormatContract : public testing::TestWithParam<const Format*> {
 protected:
  static const Format& format() { return *GetParam(); }
};

std::vector<const Format*> writable() {
  std::vector<const Format*> list;
  for (const Format* format : formats())
    if (format->is_writable()) list.push_back(format);
  return list;
}

TEST_P(FormatContract, ReadsBackWhatItWrote) {
  expect_same(format().read(format().write(sample()), {}), sample());
}

// A format may be unable to hold a missing point; then it has to say so.
TEST_P(FormatContract, KeepsAMissingPointMissing) {
  Trace trace = sample();
  trace.values[0] = trace.values[5] = kNan;
  std::string bytes;
  try {
    bytes = format().write(trace);
  } catch (const UsageError&) {
    return;
  }
  expect_same(format().read(bytes, {}), trace);
}

TEST_P(FormatContract, WritesTheSameBytesForWhatItReadBack) {
  const std::string once = format().write(format().read(format().write(sample()), {}));
  EXPECT_EQ(format().write(format().read(once, {})), once);
}

TEST_P(FormatContract, IsTheOnlyOneToRecogniseWhatItWrote) {
  const std::string bytes = format().write(sample());
  for (const Format* other : formats())
    EXPECT_EQ(other->recognises(bytes), other == &format()) << other->name();
}

// Whether a reader of plain text cannot tell: the cut runs between rows, or through the digits of
// the last value. Within a row before its last value it has to tell.
bool can_not_be_told(const std::string& whole, std::size_t size) {
  const std::size_t header = whole.find('\n') + 1;
  if (size <= header) return false;
  const std::string last =
      whole.substr(whole.rfind('\n', size - 1) + 1, size - whole.rfind('\n', size - 1) - 1);
  return last.empty() || last.find(',') + 1 < last.size();
}

// Read as whatever it looks like, as read_trace() does: half a file of one format must not pass for
// a file of another. The start "1 2" of a PRF is a text of one point, which is no profile yet.
TEST_P(FormatContract, RefusesEveryTruncationWithAReason) {
  const std::string whole = format().write(sample());
  const bool is_text = !format().states_units();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string cut = whole.substr(0, size);
    try {
      const std::size_t points = recognised_format(cut).read(cut, {}).values.size();
      EXPECT_TRUE(is_text ? can_not_be_told(whole, size) : points < 2)
          << size << " of " << whole.size();
    } catch (const DataError& error) {
      const std::string what = error.what();
      EXPECT_FALSE(what.empty());
      EXPECT_EQ(what.find_first_of("\n\r"), std::string::npos) << what;
      EXPECT_LT(what.size(), 1000U);
    }
  }
}

TEST_P(FormatContract, RefusesToWriteWhatNoFileCanHold) {
  Trace trace = sample();
  trace.positions[3] = kNan;
  EXPECT_THROW(static_cast<void>(format().write(trace)), UsageError);
  trace = sample();
  trace.values[3] = HUGE_VAL;
  EXPECT_THROW(static_cast<void>(format().write(trace)), UsageError);
  EXPECT_THROW(static_cast<void>(format().write({{}, {}, "mm", "um", {}})), UsageError);
}

TEST_P(FormatContract, IsFoundByItsEndings) {
  for (const std::string_view ending : format().endings())
    EXPECT_EQ(&format_to_write("face" + std::string(ending)), &format()) << ending;
}

INSTANTIATE_TEST_SUITE_P(All, FormatContract, testing::ValuesIn(writable()),
                         [](const auto& format) {
                           std::string name;
                           for (const char c : format.param->name())
                             if (c != ' ') name += c;
                           return name;
                         });

TEST(Formats, EndWithDelimitedText) {
  EXPECT_EQ(formats().back()->name(), "text");
  EXPECT_EQ(&recognised_format("x,z\n0,1\n"), formats().back());
}

TEST(Formats, AreWrittenByEndingInCapitalsOrNot) {
  EXPECT_EQ(&format_to_write("A.CSV"), formats().back());
  EXPECT_THROW(format_to_write("a.zzz"), UsageError);
  EXPECT_THROW(format_to_write("csv"), UsageError);
}

}  // namespace
}  // namespace slideway::contract_test
