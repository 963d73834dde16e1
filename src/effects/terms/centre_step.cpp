#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

double centre_step_value(double x, double) { return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0; }

// On one side of the axis it would be an offset.
}  // namespace

std::unique_ptr<Effect> make_centre_step(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "centre_step",
                      .plain_name = "step at the centre",
                      .standard_name = "synchronous axial error motion of the spindle, odd orders "
                                       "(ISO 230-7)",
                      .formula = "A sgn(X)",
                      .source = "ISO 230-7",
                      .cause =
                          "axial motion of odd order per turn: the two halves of a diameter were "
                          "cut at opposite spindle angles",
                      .typical = "5 to 50 nm (aerostatic spindle), 0.1 to 1 µm (rolling bearings)",
                      .variable = IndependentVariable::trace,
                      .confounded_with =
                          "centring, the trace off the centre of a conical face, exactly",
                      .confounded_effects = {"centring"},
                      .separated_by = "traces at three or more azimuths: the step goes with the "
                                      "spindle angle; on a radius it cannot be seen"},
      .amplitude = {"height_um", "A", "µm", 0.01},
      .reading = [](const Stations& stations, Eigen::Index i) { return stations.trace(i); },
      .value = centre_step_value,
      .applies_to = crosses_the_axis});
}

}  // namespace slideway
