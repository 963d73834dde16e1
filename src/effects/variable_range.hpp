#pragma once

#include <utility>

#include "slideway/effects/effect.hpp"

namespace slideway {

// Reads an independent variable at a station, e.g.
// [](const Stations& s, Eigen::Index i) { return s.time(i); }
using VariableReading = double (*)(const Stations&, Eigen::Index);

double time_of(const Stations& stations, Eigen::Index i);
double slide_of(const Stations& stations, Eigen::Index i);
double radius_of(const Stations& stations, Eigen::Index i);
double revolution_of(const Stations& stations, Eigen::Index i);
double distance_m_of(const Stations& stations, Eigen::Index i);
double measuring_time_of(const Stations& stations, Eigen::Index i);
double reading_time_of(const Stations& stations, Eigen::Index i);

Eigen::VectorXd readings(const Stations& stations, VariableReading reading);

// The range of an independent variable over a profile.
struct VariableRange {
  double low = 0.0, high = 0.0;
  double step = 0.0;  // mean change from one sample to the next

  [[nodiscard]] double extent() const { return high - low; }
};

// Of a variable that runs one way on either side of the spindle axis: the ends of both say it.
// REQUIRES increasing positions.
VariableRange range_of(const Stations& stations, VariableReading reading);

// Of any readings, one at least.
VariableRange range_of(const Eigen::VectorXd& readings);

// Time constants (or distances) of a transient the profile can show.
std::pair<double, double> transient_range(const Stations& stations, VariableReading reading);

// How far beside the axis a tool or a trace may pass, mm: the face is a parabola beyond a fifth of
// its radius.
std::pair<double, double> distance_from_axis(const Stations& stations);

// Which readings see an effect.
bool is_height(const Setup& setup);
bool is_face_height(const Setup& setup);
// Else a step at the axis is an offset.
bool crosses_the_axis(const Setup& setup);

// The sign of what is the instrument's.
double sign_of_instrument(const Setup& setup);

// What readings of an error that a reversal shows lack together: both ways round.
std::vector<std::string> lacking_of_reversal(const std::vector<const Setup*>& setups);

}  // namespace slideway
