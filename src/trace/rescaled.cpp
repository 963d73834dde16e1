#include "rescaled.hpp"

#include <algorithm>
#include <memory>

namespace slideway {

Profile rescaled(Profile profile, double factor) {
  Setup& setup = profile.setup;
  const double radius = std::max(setup.last_mm - setup.center_mm, setup.center_mm - setup.first_mm);
  if (setup.cut_radius_mm == radius) *setup.cut_radius_mm *= factor;
  if (setup.first_mm <= setup.center_mm && setup.center_mm <= setup.last_mm)
    setup.center_mm *= factor;
  setup.first_mm *= factor;
  setup.last_mm *= factor;
  for (double& each : profile.positions) each *= factor;
  if (setup.reading_times) {
    ReadingTimes times = *setup.reading_times;
    for (double& each : times.positions_mm) each *= factor;
    setup.reading_times = std::make_shared<const ReadingTimes>(std::move(times));
  }
  return profile;
}

}  // namespace slideway
