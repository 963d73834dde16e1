#include "variable_range.hpp"

#include <algorithm>
#include <cmath>

namespace slideway {

double time_of(const Stations& stations, Eigen::Index i) { return stations.time(i); }
double slide_of(const Stations& stations, Eigen::Index i) { return stations.slide(i); }
double radius_of(const Stations& stations, Eigen::Index i) { return stations.radius(i); }
double revolution_of(const Stations& stations, Eigen::Index i) { return stations.revolution(i); }
double distance_m_of(const Stations& stations, Eigen::Index i) {
  return stations.distance(i) / kMetre;
}
double measuring_time_of(const Stations& stations, Eigen::Index i) {
  return stations.measuring_time(i);
}

double reading_time_of(const Stations& stations, Eigen::Index i) {
  return stations.reading_time(i);
}

Eigen::VectorXd readings(const Stations& stations, VariableReading reading) {
  Eigen::VectorXd out(stations.size());
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = reading(stations, i);
  return out;
}

VariableRange range_of(const Stations& stations, VariableReading reading) {
  if (stations.size() == 0) return {};
  const std::span<const double> at = stations.positions();
  const Eigen::Index last = stations.size() - 1;
  // On a diameter the variables of the cut run there and back.
  const Eigen::Index beyond =
      stations.setup().kind == Kind::face
          ? std::ranges::lower_bound(at, stations.setup().center_mm) - at.begin()
          : 0;
  VariableRange range{reading(stations, 0), reading(stations, 0), 0.0};
  double travelled = 0.0;
  double previous = range.low;
  for (const Eigen::Index i :
       {std::clamp<Eigen::Index>(beyond - 1, 0, last), std::min(beyond, last), last}) {
    const double value = reading(stations, i);
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
    travelled += std::abs(value - previous);
    previous = value;
  }
  if (last > 0) range.step = travelled / static_cast<double>(last);
  return range;
}

VariableRange range_of(const Eigen::VectorXd& readings) {
  VariableRange range{readings.minCoeff(), readings.maxCoeff(), 0.0};
  const Eigen::Index steps = readings.size() - 1;
  if (steps > 0)
    range.step =
        (readings.tail(steps) - readings.head(steps)).cwiseAbs().sum() / static_cast<double>(steps);
  return range;
}

std::pair<double, double> transient_range(const Stations& stations, VariableReading reading) {
  const VariableRange range = range_of(stations, reading);
  return {4.0 * range.step, 10.0 * range.extent()};
}

std::pair<double, double> distance_from_axis(const Stations& stations) {
  constexpr double kLeast = 0.005, kMost = 10.0, kOfTheRadius = 0.2;
  return {kLeast, std::clamp(kOfTheRadius * range_of(stations, radius_of).high, 1.0, kMost)};
}

bool is_height(const Setup& setup) { return setup.quantity == Quantity::height; }

bool is_face_height(const Setup& setup) { return is_height(setup) && setup.kind == Kind::face; }

bool crosses_the_axis(const Setup& setup) {
  return is_face_height(setup) && setup.first_mm < setup.center_mm &&
         setup.center_mm < setup.last_mm;
}

double sign_of_instrument(const Setup& setup) { return setup.reversed ? -1.0 : 1.0; }

std::vector<std::string> lacking_of_reversal(const std::vector<const Setup*>& setups) {
  const auto reversed = std::ranges::count_if(setups, &Setup::reversed);
  if (reversed > 0 && reversed < std::ssize(setups)) return {};
  return {"readings with reversed = true beside others"};
}

}  // namespace slideway
