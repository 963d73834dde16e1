#include "slideway/base/date.hpp"

#include <gtest/gtest.h>

namespace slideway {
namespace {

using namespace std::chrono;

TEST(ParseDate, IsADayOfTheCalendar) {
  EXPECT_EQ(parse_date("2026-11-23"), 2026y / November / 23);
  EXPECT_EQ(parse_date("2024-02-29"), 2024y / February / 29);
  // 2100 is no leap year (Gregorian calendar).
  for (const char* none : {"2026-02-30", "2100-02-29", "2026-13-01", "2026-00-10", "2026-11-00"})
    EXPECT_EQ(parse_date(none), std::nullopt) << none;
}

TEST(ParseDate, HasOneForm) {
  for (const char* other : {"", "2026-11", "2026-1-23", "23.11.2026", "2026-11-23T08:30",
                            "2026/11/23", " 2026-11-23", "+026-11-23", "2026-11-2\xc2\xb3"})
    EXPECT_EQ(parse_date(other), std::nullopt) << other;
}

}  // namespace
}  // namespace slideway
