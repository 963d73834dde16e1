#include "../groove.hpp"
#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

std::pair<double, double> step_search(const Stations& stations) {
  const VariableRange range = range_of(stations, radius_of);
  return {range.low + range.step, range.high - range.step};
}

}  // namespace

std::unique_ptr<Effect> make_step(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "step",
                      .plain_name = "step",
                      .standard_name = "sudden change of the tool position during the cut",
                      .formula = "A where r < position, else 0",
                      .source = "an event of the cut, at one radius",
                      .cause =
                          "chipped edge, built-up edge that forms or breaks off, a pause, a jump "
                          "of the Z scale",
                      .typical = "5 to 500 nm",
                      .variable = IndependentVariable::radius,
                      .confounded_with = "a fast transient (thermal_drift, tool_running_in) that "
                                         "starts late, dust in the trace",
                      .confounded_effects = {"thermal_drift", "tool_running_in"},
                      .separated_by =
                          "both halves of a diameter show it at the same radius; the next "
                          "part does not",
                      .axisymmetric = true},
      .amplitude = {"height_um", "A", "µm", 0.1},
      .reading = tool_radius_of,
      .value = [](double radius, double position) { return radius < position ? 1.0 : 0.0; },
      .applies_to = is_face_height,
      .shape = ShapeSpec{.parameter = {"position_mm", "r_c", "mm", 1.0, 0.0},
                         .shape = {.parameter = 1, .logarithmic = false, .stepwise = true},
                         .derivative = nullptr,
                         .range = step_search}});
}

}  // namespace slideway
