#include <gmock/gmock.h>

#include "slideway/base/error.hpp"
#include "slideway/batch/pool.hpp"

namespace slideway::times_test {
namespace {

using testing::HasSubstr;

TEST(Times, AreNumbersOrDates) {
  const auto times = [](const std::string& a, const std::string& b) {
    return read_times(
        parse_manifest("id,problem,time\n1,p," + a + "\n2,p," + b + "\n3,p,\n", "m.csv"));
  };
  // 2000-01-01 is day 10957 since 1970: 30 years with 7 leap days.
  const Times dates = times("2000-01-01", "2000-01-02T06:00");
  EXPECT_TRUE(dates.are_dates);
  EXPECT_EQ(dates.values[0], 10957.0);
  EXPECT_EQ(dates.values[1], 10958.25);
  EXPECT_FALSE(dates.values[2]);
  EXPECT_EQ(times("1.5", "2e3").values[1], 2000.0);
  for (const char* bad : {"2026-13-01", "yesterday", "nan", "2026-02-30", "2026-01-01x"}) {
    try {
      times("2000-01-01", bad);
      ADD_FAILURE() << bad;
    } catch (const DataError& error) {
      EXPECT_THAT(error.what(), HasSubstr("m.csv: line 3: column 'time'"));
    }
  }
}

}  // namespace
}  // namespace slideway::times_test
