#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "slideway/profile/profile.hpp"

/// Lines of a plate, for tests.
namespace slideway::lines {

using Point = std::array<double, 2>;

inline Profile named(const std::string& name, const Point& from, const Point& to) {
  Profile out;
  out.name = name;
  out.line = Line{from, to};
  return out;
}

/// What reading a file would say of the positions.
inline void complete(Profile& line) {
  line.setup.first_mm = line.line->first_mm = line.positions.front();
  line.setup.last_mm = line.line->last_mm = line.positions.back();
}

/// Two diagonals, four sides, two centre lines; ends in halves of the plate.
struct UnionJack {
  const char* name;
  std::array<int, 4> ends;  // x, y of one, x, y of the other
  std::size_t steps;

  [[nodiscard]] Point from(double width, double height) const {
    return {0.5 * width * ends[0], 0.5 * height * ends[1]};
  }
  [[nodiscard]] Point to(double width, double height) const {
    return {0.5 * width * ends[2], 0.5 * height * ends[3]};
  }
};
inline constexpr UnionJack kUnionJack[] = {
    {"top", {0, 2, 2, 2}, 16},      {"bottom", {0, 0, 2, 0}, 16}, {"centre_x", {0, 1, 2, 1}, 16},
    {"left", {0, 2, 0, 0}, 10},     {"right", {2, 2, 2, 0}, 10},  {"centre_y", {1, 2, 1, 0}, 10},
    {"diagonal", {0, 2, 2, 0}, 18}, {"other", {0, 0, 2, 2}, 18}};

/// Sets the heights at the ends and in the middle of a Union Jack to one value for each place, as a
/// reduction to a common plane does: each line without its own offset and tilt, then the first
/// line's value.
inline void tie(std::vector<Profile>& plate) {
  std::vector<std::pair<Point, double>> known;
  for (Profile& line : plate) {
    std::vector<double>& z = line.values;
    const double first = z.front(), last = z.back();
    const auto n = static_cast<double>(z.size() - 1);
    for (std::size_t i = 0; i < z.size(); ++i)
      z[i] -= first + (last - first) * static_cast<double>(i) / n;
    for (const std::size_t i : {std::size_t{0}, z.size() / 2, z.size() - 1}) {
      const double t = static_cast<double>(i) / n;
      const Point from = line.line->from_mm, to = line.line->to_mm;
      const Point at{from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])};
      bool found = false;
      for (const auto& [place, value] : known)
        if (std::hypot(place[0] - at[0], place[1] - at[1]) < 1.0) {
          z[i] = value;
          found = true;
        }
      if (!found) known.emplace_back(at, z[i]);
    }
  }
}

}  // namespace slideway::lines
