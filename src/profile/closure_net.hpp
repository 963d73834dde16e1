#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slideway/profile/closure.hpp"
#include "slideway/profile/profile.hpp"

namespace slideway {

// A profile as heights at stations along its line.
struct HeightLine {
  const Profile* profile = nullptr;
  std::size_t index = 0;          // of the profile
  std::array<double, 2> along{};  // from one end to the other, mm
  std::vector<double> at;         // stations: share of `along`, ascending
  std::vector<double> heights;    // mm
  double step = 0.0;              // median, share of `along`
  double bend = 0.0;              // median of a height less the middle of its neighbours

  [[nodiscard]] double half_station_mm() const;
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
  std::vector<std::array<double, 2>> places;
  std::vector<Reading> readings;  // by place; each place has two at least
  std::vector<std::string> notes;
  bool tied = false;
};

// Pairs of lines with the same ends.
std::vector<Repeat> repeats(const ClosureNet& net);

ClosureNet closure_net(const std::vector<Profile>& profiles);

}  // namespace slideway
