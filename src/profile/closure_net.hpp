#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slideway/profile/closure.hpp"
#include "slideway/profile/profile.hpp"

namespace slideway {

// A place on the surface, or the way from one to another; mm.
using Point = std::array<double, 2>;
inline Point between(const Point& a, const Point& b) { return {b[0] - a[0], b[1] - a[1]}; }
inline double length(const Point& a) { return std::hypot(a[0], a[1]); }

// Each value less the middle of those `lag` to either side.
std::vector<double> bends(const std::vector<double>& z, std::size_t lag);

// A profile as heights at stations along its line.
struct HeightLine {
  const Profile* profile = nullptr;
  std::size_t index = 0;        // of the profile
  Point along{};                // from one end to the other
  std::vector<double> at;       // stations: share of `along`, ascending
  std::vector<double> heights;  // mm
  double step = 0.0;            // median, share of `along`
  double bend = 0.0;            // median of a height less the middle of its neighbours

  [[nodiscard]] double half_station_mm() const;
  [[nodiscard]] Point place(double t) const;  // at a share of the line
  struct Height {
    double value = 0.0;
    double bends = 0.0;  // by how many bends it may be off: 1 between neighbours, 2 beyond an end
  };
  // The height at a place; `beside`: by the stations about it and not the one there. None where
  // stations are missing.
  [[nodiscard]] std::optional<Height> height(double t, bool beside) const;
};

// One line's reading where it meets others.
struct Reading {
  std::size_t line = 0, place = 0;
  double t = 0.0;  // share of the line
  HeightLine::Height height;
};

struct ClosureNet {
  std::vector<HeightLine> lines;
  std::vector<Point> places;
  std::vector<Reading> readings;  // by place; each place has two at least
  std::vector<std::string> notes;
  bool tied = false;
};

// Pairs of lines with the same ends.
std::vector<Repeat> repeats(const ClosureNet& net);

ClosureNet closure_net(const std::vector<Profile>& profiles);

}  // namespace slideway
