#include "format/areal.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "slideway/base/error.hpp"

namespace slideway::areal_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::Pointwise;
using testing::SizeIs;
using testing::ThrowsMessage;

// Heights that are linear along x and along y, which bilinear interpolation gives back exactly.
Grid twisted_plane(std::size_t columns, std::size_t rows) {
  Grid grid{even_positions(columns, -3.0, 0.5), even_positions(rows, 10.0, 2.0), {}};
  for (const double y : grid.y)
    for (const double x : grid.x) grid.heights.push_back(1.0 + 2.0 * x - 3.0 * y + 0.25 * x * y);
  return grid;
}

TEST(LineOf, TakesRowsAndColumns) {
  const Grid grid{{1.0, 2.0, 3.0}, {5.0, 6.0}, {1, 2, 3, 4, 5, 6}};
  const Trace row = line_of(grid, {.line = "row:2"}, "m");
  EXPECT_THAT(row.positions, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(row.values, ElementsAre(4.0, 5.0, 6.0));
  EXPECT_EQ(row.position_unit, "m");
  EXPECT_THAT(row.decisions, ElementsAre("2 rows of 3 points; read the line row:2"));
  const Trace column = line_of(grid, {.line = "column:3"}, "m");
  EXPECT_THAT(column.positions, ElementsAre(5.0, 6.0));
  EXPECT_THAT(column.values, ElementsAre(3.0, 6.0));
}

TEST(LineOf, NeedsNoChoiceInOneRow) {
  const Grid grid{{1.0, 2.0, 3.0}, {5.0}, {1, 2, 3}};
  EXPECT_THAT(line_of(grid, {.line = ""}, "m").values, ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(line_of(grid, {.line = "row:1"}, "m").values, ElementsAre(1.0, 2.0, 3.0));
}

TEST(LineOf, NamesTheChoicesAndTheSize) {
  const Grid grid = twisted_plane(4, 3);
  for (const char* line : {"", "row", "row:0", "row:4", "row:1.5", "row:x", "column:5", "column:-1",
                           "diameter:", "diameter:nan", "diagonal:1", "row:1e300", ":"})
    EXPECT_THAT(
        [&] { (void)line_of(grid, {.line = line}, "m"); },
        ThrowsMessage<UsageError>(HasSubstr("3 rows of 4 points; accepted: \"row:1\" to \"row:3\", "
                                            "\"column:1\" to \"column:4\", \"diameter:DEGREES\"")))
        << line;
}

TEST(LineOf, InterpolatesAlongADiameter) {
  const Grid grid = twisted_plane(13, 9);  // x from -3 to 3, y from 10 to 26
  for (const double degrees : {0.0, 30.0, 45.0, 90.0, 135.0, 200.0, -60.0}) {
    const Trace line = line_of(grid, {.line = "diameter:" + std::to_string(degrees)}, "mm");
    const double c = std::cos(degrees * M_PI / 180.0);
    const double s = std::sin(degrees * M_PI / 180.0);
    ASSERT_EQ(line.positions.size() % 2, 1) << degrees;
    EXPECT_EQ(line.positions[line.positions.size() / 2], 0.0) << degrees;
    const double spacing = std::hypot(0.5 * c, 2.0 * s);
    for (std::size_t i = 0; i < line.positions.size(); ++i) {
      const double x = line.positions[i] * c;
      const double y = 18.0 + line.positions[i] * s;
      // Heights reach 90: 1e-12 is some roundings.
      EXPECT_NEAR(line.values[i], 1.0 + 2.0 * x - 3.0 * y + 0.25 * x * y, 1e-12) << degrees;
      EXPECT_NEAR(line.positions[i] - line.positions[0], static_cast<double>(i) * spacing, 1e-12)
          << degrees;
    }
  }
  EXPECT_THAT(line_of(grid, {.line = "diameter:0"}, "mm").positions, SizeIs(13));
  EXPECT_THAT(line_of(grid, {.line = "diameter:90"}, "mm").positions, SizeIs(9));
  EXPECT_THAT(line_of(grid, {.line = "diameter:180"}, "mm").positions, SizeIs(13));
}

TEST(LineOf, KeepsMissingPointsMissingAlongADiameter) {
  Grid grid{even_positions(5, 0.0, 1.0), even_positions(5, 0.0, 1.0), std::vector<double>(25, 1.0)};
  grid.heights[2 * 5 + 3] = std::nan("");
  EXPECT_THAT(line_of(grid, {.line = "diameter:0"}, "m").values,
              ElementsAre(1.0, 1.0, 1.0, IsNan(), 1.0));
  EXPECT_THAT(line_of(grid, {.line = "diameter:90"}, "m").values, Each(1.0));
}

TEST(LineOf, BoundsADiameterInAGridOfUnlikeSpacings) {
  Grid grid{even_positions(2, 0.0, 1e-9), even_positions(2, 0.0, 1e9), {1, 1, 1, 1}};
  for (const double degrees : {0.0, 1e-12, 45.0, 89.999999, 90.0})
    EXPECT_LE(line_of(grid, {.line = "diameter:" + std::to_string(degrees)}, "m").values.size(), 5);
}

TEST(LineOf, RefusesADiameterOverPositionsThatDoNotIncrease) {
  EXPECT_THROW((void)line_of({{0.0, 0.0}, {0.0, 1.0}, {1, 2, 3, 4}}, {.line = "diameter:0"}, "m"),
               DataError);
}

TEST(GridOfPoints, FindsRows) {
  const Grid grid = grid_of_points({1, 2, 1, 2, 1, 2}, {5, 5, 6, 6, 7, 7}, {1, 2, 3, 4, 5, 6});
  EXPECT_THAT(grid.x, ElementsAre(1.0, 2.0));
  EXPECT_THAT(grid.y, ElementsAre(5.0, 6.0, 7.0));
  EXPECT_EQ(grid.height(2, 1), 6.0);
  EXPECT_THROW((void)grid_of_points({1, 2, 1, 3}, {5, 5, 6, 6}, {1, 2, 3, 4}), DataError);
  EXPECT_THROW((void)grid_of_points({1, 2, 1}, {5, 5, 6}, {1, 2, 3}), DataError);
  EXPECT_THROW((void)grid_of_points({}, {}, {}), DataError);
}

}  // namespace
}  // namespace slideway::areal_test
