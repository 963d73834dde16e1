#include "groove.hpp"

#include <cmath>
#include <cstdint>

namespace slideway {

namespace {

// std::round, which baseline x86-64 has to call for.
double nearest_whole(double x) {
  if (!(std::abs(x) < 0x1p52)) return x;  // has no fraction
  const auto toward_zero = static_cast<double>(static_cast<std::int64_t>(x));
  const double rest = x - toward_zero;
  return toward_zero + (rest >= 0.5 ? 1.0 : 0.0) - (rest <= -0.5 ? 1.0 : 0.0);
}

}  // namespace

bool has_grooves(const Setup& setup) {
  return setup.kind == Kind::face && setup.feed_mm_per_min && setup.spindle_rpm &&
         setup.cut_direction && setup.cut_radius_mm;
}

Groove groove_at(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  const double far_half = stations.trace(i) < 0.0 ? 0.5 : 0.0;
  const double r = stations.radius(i);
  const double path = setup.cut_direction == CutDirection::inward ? *setup.cut_radius_mm - r : r;
  const double turns = path * *setup.spindle_rpm / *setup.feed_mm_per_min - far_half;
  const double whole = nearest_whole(turns);
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
