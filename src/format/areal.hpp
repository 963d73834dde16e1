#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "slideway/format/format.hpp"

/// Heights over a grid, and the lines that can be taken out of it.
namespace slideway {

struct Grid {
  std::vector<double> x;        // of the columns
  std::vector<double> y;        // of the rows
  std::vector<double> heights;  // row after row; NaN where missing

  [[nodiscard]] double height(std::size_t row, std::size_t column) const {
    return heights[row * x.size() + column];
  }
};

/// `count` positions from `start`, `step` apart.
/// @throws DataError where the last is no finite number
std::vector<double> even_positions(std::size_t count, double start, double step);

/// Points given row after row as a grid: a row ends where y changes.
/// @throws DataError unless x is the same in every row and y the same along each
Grid grid_of_points(const std::vector<double>& x, const std::vector<double>& y,
                    std::vector<double> heights);

/// The line a request asks for: "row:2" along x, "column:3" along y (both counted from 1), or
/// "diameter:30", the line through the centre at 30 degrees from x to y, interpolated bilinearly
/// in the spacing of the grid, hypot(dx cos, dy sin); its positions count from the centre. A grid
/// of one row is a profile and needs no request. What the grid holds if that is accepted instead.
/// @throws UsageError  no line asked for, or one that is not there
/// @throws DataError   a diameter over positions that do not increase
Trace line_of(const Grid& grid, const TraceRequest& request, std::string_view unit);

}  // namespace slideway
