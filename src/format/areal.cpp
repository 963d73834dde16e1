#include "areal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

std::string size_of(const Grid& grid) {
  return std::to_string(grid.y.size()) + " rows of " + std::to_string(grid.x.size()) + " points";
}

[[noreturn]] void refuse(const Grid& grid, std::string_view line) {
  const std::string asked =
      line.empty() ? "no line is chosen" : "line = \"" + printable(line) + "\"";
  throw UsageError(asked + ": the file holds " + size_of(grid) + R"(; accepted: "row:1" to "row:)" +
                   std::to_string(grid.y.size()) + R"(", "column:1" to "column:)" +
                   std::to_string(grid.x.size()) + R"(", "diameter:DEGREES")");
}

// Index of a row or column counted from 1.
std::optional<std::size_t> index_of(double number, std::size_t count) {
  if (!(number >= 1.0 && number <= static_cast<double>(count)) || number != std::floor(number))
    return std::nullopt;
  return static_cast<std::size_t>(number) - 1;
}

// Where a position lies: between `index` and the next, at `fraction` of the way.
struct Place {
  std::size_t index;
  double fraction;
};

Place place_of(const std::vector<double>& positions, double at) {
  const auto above = std::upper_bound(positions.begin() + 1, positions.end() - 1, at);
  const auto index = static_cast<std::size_t>(above - positions.begin()) - 1;
  const double fraction = (at - positions[index]) / (positions[index + 1] - positions[index]);
  return {index, std::clamp(fraction, 0.0, 1.0)};
}

double interpolated(const Grid& grid, double x, double y) {
  const Place column = place_of(grid.x, x);
  const Place row = place_of(grid.y, y);
  double height = 0.0;
  for (const std::size_t down : {0, 1})
    for (const std::size_t right : {0, 1}) {
      const double weight = (down == 1 ? row.fraction : 1.0 - row.fraction) *
                            (right == 1 ? column.fraction : 1.0 - column.fraction);
      // A missing neighbour spoils the point unless it has no part in it.
      if (weight > 0.0) height += weight * grid.height(row.index + down, column.index + right);
    }
  return height;
}

bool increases(const std::vector<double>& positions) {
  return std::adjacent_find(positions.begin(), positions.end(), std::greater_equal<>()) ==
         positions.end();
}

double mean_spacing(const std::vector<double>& positions) {
  return (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
}

void take_diameter(const Grid& grid, double degrees, Trace& trace) {
  if (!increases(grid.x) || !increases(grid.y))
    throw DataError("a diameter needs positions that increase along x and y");
  const std::array<double, 2> along{std::cos(degrees * kPi / 180.0),
                                    std::sin(degrees * kPi / 180.0)};
  const std::array<const std::vector<double>*, 2> axes{&grid.x, &grid.y};
  std::array<double, 2> centre{};
  double reach = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 2; ++i) {
    const double half = 0.5 * (axes[i]->back() - axes[i]->front());
    centre[i] = axes[i]->front() + half;
    reach = std::min(reach, half / std::abs(along[i]));
  }
  // That of the columns along x, of the rows along y, and where both are the same that at any
  // angle.
  const double spacing =
      std::hypot(along[0] * mean_spacing(grid.x), along[1] * mean_spacing(grid.y));
  constexpr double kRounding = 1e-9;  // a last step that ends on the edge is taken
  const double steps = std::floor(reach / spacing + kRounding);
  for (double step = -steps; step <= steps; ++step) {
    const double position = step * spacing;
    trace.positions.push_back(position);
    trace.values.push_back(
        interpolated(grid, centre[0] + position * along[0], centre[1] + position * along[1]));
  }
  trace.decisions.push_back("positions count from the centre of the grid, " +
                            significant(spacing, 6) + " " + trace.position_unit + " apart");
}

Areal areal(const Grid& grid) {
  Areal out{grid.x, grid.y, 0, {}};
  for (const double height : grid.heights) {
    if (std::isnan(height)) {
      ++out.missing;
      continue;
    }
    const auto [low, high] = out.heights.value_or(std::pair(height, height));
    out.heights = {std::min(low, height), std::max(high, height)};
  }
  return out;
}

}  // namespace

std::vector<double> even_positions(std::size_t count, double start, double step) {
  std::vector<double> positions(count);
  for (std::size_t i = 0; i < count; ++i) positions[i] = start + static_cast<double>(i) * step;
  if (count > 0 && !std::isfinite(positions.back()))
    throw DataError("spacing: " + std::to_string(count) + " points " + shortest(step) +
                    " apart; accepted: one that leaves positions finite");
  return positions;
}

Grid grid_of_points(const std::vector<double>& x, const std::vector<double>& y,
                    std::vector<double> heights) {
  const auto change = std::find_if(y.begin(), y.end(), [&](double at) { return at != y.front(); });
  const auto columns = static_cast<std::size_t>(change - y.begin());
  bool regular = columns > 0 && x.size() % columns == 0;
  for (std::size_t i = 0; regular && i < x.size(); ++i)
    regular = x[i] == x[i % columns] && y[i] == y[i / columns * columns];
  if (!regular)
    throw DataError("the " + std::to_string(x.size()) +
                    " points are no grid; accepted: rows of the same x, each at one y");
  Grid grid{{x.begin(), x.begin() + static_cast<std::ptrdiff_t>(columns)}, {}, std::move(heights)};
  for (std::size_t i = 0; i < y.size(); i += columns) grid.y.push_back(y[i]);
  return grid;
}

Trace line_of(const Grid& grid, const TraceRequest& request, std::string_view unit) {
  const std::string_view line = request.line;
  Trace trace;
  trace.position_unit = trace.value_unit = unit;
  const bool profile = grid.y.size() == 1;
  if (!profile && line.empty() && request.areal_without_line) {
    trace.areal = areal(grid);
    return trace;
  }
  const std::size_t colon = line.find(':');
  const std::string_view kind = profile && line.empty() ? "row" : line.substr(0, colon);
  double number = 1.0;
  if (!line.empty()) {
    const auto given = colon < line.size() ? parse_double(line.substr(colon + 1)) : std::nullopt;
    if (!given || !std::isfinite(*given)) refuse(grid, line);
    number = *given;
  }
  if (const auto row = index_of(number, grid.y.size()); kind == "row" && row) {
    const auto first = grid.heights.begin() + static_cast<std::ptrdiff_t>(*row * grid.x.size());
    trace.positions = grid.x;
    trace.values.assign(first, first + static_cast<std::ptrdiff_t>(grid.x.size()));
  } else if (const auto column = index_of(number, grid.x.size()); kind == "column" && column) {
    trace.positions = grid.y;
    for (std::size_t i = 0; i < grid.y.size(); ++i) trace.values.push_back(grid.height(i, *column));
  } else if (kind == "diameter" && grid.x.size() > 1 && grid.y.size() > 1) {
    take_diameter(grid, number, trace);
  } else {
    refuse(grid, line);
  }
  if (!profile)
    trace.decisions.insert(trace.decisions.begin(),
                           size_of(grid) + "; read the line " + std::string(line));
  return trace;
}

}  // namespace slideway
