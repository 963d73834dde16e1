#include "../periodic_effect.hpp"
#include "../request.hpp"

namespace slideway {
namespace {

std::pair<double, double> traverse_periodic_search(const Stations& stations) {
  const VariableRange range = range_of(stations, measuring_time_of);
  return {0.5 / range.extent(), 0.25 / range.step};
}

}  // namespace

std::unique_ptr<Effect> make_traverse_periodic(const Request& request) {
  request.accept_only({});
  return std::make_unique<PeriodicEffect>(PeriodicSpec{
      .description = {.name = "traverse_periodic",
                      .plain_name = "wave of the traverse unit",
                      .standard_name = "periodic disturbance of the measuring instrument",
                      .formula = "A cos(2πfX/v + φ), v the speed of the stylus",
                      .source = "profilometer in its room, not the machine tool",
                      .cause = "vibration of the floor or mains hum while the trace is measured",
                      .typical = "1 to 20 nm; floors shake at 5 to 20 Hz, mains hum at 50 or 60 Hz",
                      .variable = IndependentVariable::measuring_time,
                      .confounded_with = "slide_periodic, time_periodic and revolution_periodic in "
                                         "traces measured at one speed",
                      .confounded_effects = {"slide_periodic", "time_periodic",
                                             "revolution_periodic"},
                      .separated_by = "a second traverse speed: the wavelength follows the stylus, "
                                      "not the feed"},
      .rate = {"frequency_hz", "f", "Hz", 1.0, 0.0, 500.0},
      .rate_is_period = false,
      .reading = measuring_time_of,
      .range = traverse_periodic_search,
      .applies_to = is_height});
}

}  // namespace slideway
