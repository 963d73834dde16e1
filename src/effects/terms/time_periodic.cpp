#include "../groove.hpp"
#include "../periodic_effect.hpp"
#include "../request.hpp"

namespace slideway {

std::unique_ptr<Effect> make_time_periodic(const Request& request) {
  request.accept_only({});
  return std::make_unique<PeriodicEffect>(PeriodicSpec{
      .description =
          {.name = "time_periodic",
           .plain_name = "periodic drift",
           .standard_name = "ETVE, environmental temperature variation error, cyclic "
                            "(ISO 230-3)",
           .formula = "A cos(2πt/T + φ)",
           .source = "ISO 230-3; air supply of aerostatic ways",
           .cause = "air conditioning or coolant switching on and off, pressure cycle of "
                    "the compressor",
           .typical = "20 to 500 nm at periods of 2 to 30 min (air conditioning), 5 to "
                      "50 nm at 15 to 120 s (air supply)",
           .variable = IndependentVariable::time,
           .confounded_with = "the straightness polynomial when a cut lasts less than "
                              "about one period; slide_periodic and revolution_periodic "
                              "at one feed",
           .confounded_effects = {"straightness", "slide_periodic", "revolution_periodic"},
           .separated_by = "a second feed: the wavelength on the face is feed times T; a "
                           "temperature or pressure log"},
      .rate = {"period_s", "T", "s", 60.0, 1e-2, 1e6},
      .rate_is_period = true,
      .reading = cutting_time_of,
      .range = [](const Stations& stations) { return period_range(stations, time_of); },
      .applies_to = is_height});
}

}  // namespace slideway
