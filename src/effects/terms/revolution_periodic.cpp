#include <algorithm>

#include "../groove.hpp"
#include "../periodic_effect.hpp"
#include "../request.hpp"

namespace slideway {
namespace {

// One groove per turn samples a face: above half a cycle per turn everything is an alias. There
// other laws make lines as well: four values a period, as of those.
std::pair<double, double> revolution_periodic_search(const Stations& stations) {
  const VariableRange range = range_of(stations, revolution_of);
  const bool is_face = stations.setup().kind == Kind::face;
  return {0.5 / range.extent(), is_face ? std::min(0.25 / range.step, 0.5) : 0.5 / range.step};
}

}  // namespace

std::unique_ptr<Effect> make_revolution_periodic(const Request& request) {
  request.accept_only({});
  return std::make_unique<PeriodicEffect>(PeriodicSpec{
      .description =
          {.name = "revolution_periodic",
           .plain_name = "axial spindle motion",
           .standard_name = "asynchronous axial error motion of the spindle (ISO 230-7)",
           .formula = "A cos(2πνk + φ), k = t rpm/60",
           .source = "ISO 230-7",
           .cause = "asynchronous motion of the spindle or vibration of the structure, "
                    "sampled once per turn by the groove",
           .typical = "5 to 30 nm",
           .variable = IndependentVariable::revolution,
           .confounded_with = "slide_periodic, time_periodic and traverse_periodic at one "
                              "feed and one traverse speed; on a face ν stands for all its "
                              "aliases ν + 1, ν + 2, ...",
           .confounded_effects = {"slide_periodic", "time_periodic", "traverse_periodic"},
           .separated_by = "a second feed (the wavelength on the face is the feed per turn "
                           "over ν) and a change of spindle speed by 1 % (the alias jumps)"},
      .rate = {"cycles_per_revolution", "ν", "1", 0.1, 0.0, 1e4},
      .rate_is_period = false,
      .reading = cutting_revolution_of,
      .range = revolution_periodic_search,
      .applies_to = is_height});
}

}  // namespace slideway
