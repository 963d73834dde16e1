#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/problem.hpp"

/// Problems and profiles made in memory, as the readers would hand them over.
namespace slideway::cases {

inline std::vector<double> spaced(double first, double last, std::size_t n) {
  std::vector<double> positions(n);
  for (std::size_t i = 0; i < n; ++i)
    positions[i] = first + (last - first) * static_cast<double>(i) / static_cast<double>(n - 1);
  return positions;
}

inline Profile profile(std::string name, Kind kind, std::vector<double> positions,
                       std::vector<double> values) {
  Profile out;
  out.name = std::move(name);
  out.setup.kind = kind;
  out.setup.first_mm = positions.front();
  out.setup.last_mm = positions.back();
  out.positions = std::move(positions);
  out.values = std::move(values);
  return out;
}

/// A face cut inward at 110 rpm, whose trace runs about the spindle axis at 0; its tilt is known.
inline Profile face(std::string name, double feed_mm_per_min, std::vector<double> positions,
                    std::vector<double> values) {
  Profile out = profile(std::move(name), Kind::face, std::move(positions), std::move(values));
  out.setup.feed_mm_per_min = feed_mm_per_min;
  out.setup.spindle_rpm = 110.0;
  out.setup.cut_direction = CutDirection::inward;
  out.setup.cut_radius_mm = std::max(std::abs(out.setup.first_mm), std::abs(out.setup.last_mm));
  out.free_tilt = false;
  return out;
}

inline DeclaredEffect effect(std::string name, std::optional<int> degree = std::nullopt) {
  DeclaredEffect out;
  out.name = std::move(name);
  out.options.degree = degree;
  return out;
}

inline Problem problem(Lever lever, int level, std::vector<DeclaredEffect> effects) {
  Problem out;
  out.bodies = Machine::paper_lathe();
  out.lever = lever;
  out.low_band.level = level;
  out.effects = std::move(effects);
  return out;
}

}  // namespace slideway::cases
