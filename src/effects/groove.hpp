#pragma once

#include "slideway/effects/effect.hpp"

namespace slideway {

// A turned face is cut once per revolution: what the tool did then stands in the whole width of the
// groove.
struct Groove {
  double turn = 0.0;    // revolutions from the start of the cut: whole, half more on the far half
  double across = 0.0;  // place in it in widths of a groove, -1/2 to 1/2
};

// Whether the profile tells its grooves apart.
bool has_grooves(const Setup& setup);

// The groove under a sample; its centre lies at whole turns after the start of this cut:
// r = R - i f inward, r = i f outward, whatever the time when it started; half a turn later
// on the far half of a diameter. REQUIRES has_grooves().
Groove groove_at(const Stations& stations, Eigen::Index i);

// Radius the tool stood at, mm, when it cut what lies under a sample; the sample's own where the
// profile does not tell.
double tool_radius_of(const Stations& stations, Eigen::Index i);

// Time, s, and revolution when it was cut; continuous where there are no grooves.
double cutting_time_of(const Stations& stations, Eigen::Index i);
double cutting_revolution_of(const Stations& stations, Eigen::Index i);

}  // namespace slideway
