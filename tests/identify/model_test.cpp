#include "slideway/identify/model.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "cases.hpp"
#include "slideway/identify/other_level.hpp"

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

// The Haar wavelet adds two neighbours and divides by √2, so 16 values become 8, and what stands in
// the place of the fourth value, the second of the new ones, stays left out.
TEST(Model, AtAnotherLevelHasTheSumsOfNeighboursOfAHaarWavelet) {
  std::vector<double> values;
  for (int i = 0; i < 32; ++i) values.push_back(std::sin(0.3 * i * i));
  const std::vector<Profile> profiles{
      cases::profile("line", Kind::slide, cases::spaced(0.0, 31.0, 32), values)};
  Problem problem = cases::problem(Lever::paper, 1, {});
  problem.low_band = {.wavelet = "db1", .level = 1};
  Model model = build_model(problem, profiles);
  ASSERT_EQ(model.observations[0].values.size(), 16);
  leave_out(model.observations[0], {3});
  const std::optional<Model> up = at_other_level(model, 1, 8);
  ASSERT_TRUE(up);
  const Observation &before = model.observations[0], &after = up->observations[0];
  ASSERT_EQ(after.values.size(), 8);
  for (Eigen::Index i = 0; i < 8; ++i)
    EXPECT_NEAR(after.values[i], (before.values[2 * i] + before.values[2 * i + 1]) / std::sqrt(2.0),
                1e-12);
  EXPECT_THAT(left_out_values(after), ::testing::ElementsAre(1));
  const std::optional<Model> down = at_other_level(model, -1, 8);
  ASSERT_TRUE(down);
  EXPECT_EQ(down->observations[0].values, Eigen::Map<const Eigen::VectorXd>(values.data(), 32));
  EXPECT_THAT(left_out_values(down->observations[0]), ::testing::ElementsAre(6, 7));
  EXPECT_FALSE(at_other_level(model, 1, 9));
  EXPECT_FALSE(at_other_level(model, -2, 8));
}

}  // namespace
}  // namespace slideway
