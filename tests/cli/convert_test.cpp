#include <gmock/gmock.h>

#include <cmath>

#include "cli/bad_input.hpp"
#include "slideway/base/units.hpp"
#include "slideway/format/format.hpp"

namespace slideway::convert_test {
namespace {

using testing::HasSubstr;

class Convert : public ProgramTest {};

TEST_F(Convert, WritesTheNumbersItRead) {
  folder_.file("face.txt", "x (mm);H\xf6he [\xb5m]\n0,1;1,5\n0,2;\n0,3;1e-3\n");
  const ProgramRun done = run({"convert", "face.txt", "face.csv"});
  EXPECT_EQ(done.exit_code, 0);
  EXPECT_EQ(done.out + done.err, "");
  EXPECT_EQ(contents(path("face.csv")), "x_mm,z_um\n0.1,1.5\n0.2,\n0.3,0.001\n");
}

// There and back again through every format; ten roundings of 1.1e-16 at the most.
TEST_F(Convert, GoesRoundThroughEveryFormat) {
  folder_.file("face.csv", face_csv(64));
  const Trace given = read_trace(path("face.csv"), {}).trace;
  for (const Format* format : formats()) {
    if (!format->is_writable()) continue;
    const std::string there = "there" + std::string(format->endings().front());
    const ProgramRun first = run({"convert", "face.csv", there});
    ASSERT_EQ(first.exit_code, 0) << first.err;
    EXPECT_EQ(read_trace(path(there), {}).format, format->name());
    const ProgramRun second = run({"convert", there, "back.csv"});
    ASSERT_EQ(second.exit_code, 0) << second.err;
    const Trace back = read_trace(path("back.csv"), {}).trace;
    const UnitScale to_mm = length_unit(back.position_unit).value();
    const UnitScale to_value = length_unit(back.value_unit).value();
    ASSERT_EQ(back.values.size(), given.values.size());
    for (std::size_t i = 0; i < given.values.size(); ++i) {
      EXPECT_NEAR(to_mm(back.positions[i]), given.positions[i], 1e-15 * given.positions[i]);
      EXPECT_NEAR(to_value(back.values[i]), given.values[i] / 1e3,
                  1e-15 * std::abs(given.values[i]));
    }
  }
}

TEST_F(Convert, AddsTheUnitsItIsTold) {
  folder_.file("bare.txt", "0 1\n1 2\n");
  EXPECT_EQ(run({"convert", "bare.txt", "a.csv"}).exit_code, 0);
  EXPECT_THAT(contents(path("a.csv")), testing::StartsWith("x,z\n"));
  EXPECT_EQ(
      run({"convert", "bare.txt", "a.csv", "--position-unit", "inch", "--value-unit", "um_per_m"})
          .exit_code,
      0);
  EXPECT_THAT(contents(path("a.csv")), testing::StartsWith("x_inch,z_um_per_m\n"));
}

TEST_F(Convert, RefusesInOneLineAndWritesNothing) {
  folder_.file("face.csv", face_csv(20));
  folder_.file("bad.csv", "0,1\n1,abc\n");
  const ProgramRun ending = run({"convert", "face.csv", "face.zzz"});
  EXPECT_TRUE(is_refused(ending, 2));
  EXPECT_THAT(ending.err, HasSubstr("the ending '.zzz' is of no format that can be written"));
  EXPECT_THAT(ending.err, HasSubstr(".csv .txt .dat"));
  EXPECT_TRUE(is_refused(run({"convert", "face.csv", "face.csv"}), 2));
  EXPECT_TRUE(is_refused(run({"convert", "face.csv"}), 2));
  EXPECT_TRUE(is_refused(run({"convert", "bad.csv", "out.csv"}), 3));
  EXPECT_TRUE(is_refused(run({"convert", "gone.csv", "out.csv"}), 3));
  EXPECT_THAT(names_in(folder_.path()), testing::ElementsAre("bad.csv", "face.csv"));
}

}  // namespace
}  // namespace slideway::convert_test
