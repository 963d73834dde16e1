#include "slideway/identify/model.hpp"

#include <gtest/gtest.h>

#include "cases.hpp"

namespace slideway {
namespace {

TEST(Model, RangeReachesToTheFeetOfEachBridge) {
  const std::vector<double> travel = cases::spaced(0.0, 600.0, 64);
  std::vector<Profile> profiles;
  for (const char* name : {"outward", "inward", "again"}) {
    Profile level = cases::profile(name, Kind::slide, travel, std::vector<double>(64, 0.0));
    level.setup.quantity = Quantity::slope;
    level.setup.base_mm = 100.0;
    profiles.push_back(std::move(level));
  }
  const Model model = build_model(cases::problem(Lever::paper, 1, {}), profiles);
  EXPECT_EQ(model.range.slide_min, -50.0);
  EXPECT_EQ(model.range.slide_max, 650.0);
  const SlideRange centres = slide_range(profiles.front(), model.machine);
  EXPECT_EQ(centres.least, 0.0);
  EXPECT_EQ(centres.greatest, 600.0);
}

}  // namespace
}  // namespace slideway
