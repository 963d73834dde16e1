#include "groove.hpp"

#include <cmath>

namespace slideway {

bool has_grooves(const Setup& setup) {
  return setup.kind == Kind::face && setup.feed_mm_per_min && setup.spindle_rpm &&
         setup.cut_direction && setup.cut_radius_mm;
}

Groove groove_at(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  const double far_half = stations.trace(i) < 0.0 ? 0.5 : 0.0;
  const double turns =
      stations.revolution(i) - setup.start_s * *setup.spindle_rpm / kMinute - far_half;
  const double whole = std::round(turns);
  return {whole + far_half, turns - whole};
}

double tool_radius_of(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  if (!has_grooves(setup)) return stations.radius(i);
  const double path = groove_at(stations, i).turn * *setup.feed_mm_per_min / *setup.spindle_rpm;
  return setup.cut_direction == CutDirection::inward ? *setup.cut_radius_mm - path : path;
}

double cutting_revolution_of(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  if (!has_grooves(setup)) return stations.revolution(i);
  return setup.start_s * *setup.spindle_rpm / kMinute + groove_at(stations, i).turn;
}

double cutting_time_of(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  if (!has_grooves(setup)) return stations.time(i);
  return setup.start_s + groove_at(stations, i).turn * kMinute / *setup.spindle_rpm;
}

}  // namespace slideway
