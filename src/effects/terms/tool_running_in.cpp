#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

// A trace longer than the cut would have negative distances.
double since_start_m(const Stations& stations, Eigen::Index i) {
  return std::max(distance_m_of(stations, i), 0.0);
}

double tool_running_in_value(double s, double distance_m) { return -std::expm1(-s / distance_m); }

double tool_running_in_derivative(double s, double distance_m) {
  return -std::exp(-s / distance_m) * s / (distance_m * distance_m);
}

}  // namespace

std::unique_ptr<Effect> make_tool_running_in(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "tool_running_in",
                      .plain_name = "running-in of the tool",
                      .standard_name = "flank wear of the tool, initial phase (ISO 3685)",
                      .formula = "A (1 - exp(-s/s0))",
                      .source = "s = π (R² - r²)/f inward, π r²/f outward, f the feed per turn",
                      .cause = "a fresh edge wears quickly at first and then settles",
                      .typical = "10 to 200 nm within s0 of 0.3 to 20 m",
                      .variable = IndependentVariable::distance,
                      .confounded_with =
                          "thermal_drift at one spindle speed, edge_roll_off if s0 is "
                          "short",
                      .confounded_effects = {"thermal_drift", "edge_roll_off"},
                      .separated_by =
                          "a change of spindle speed at the same feed rate (distance "
                          "changes, time does not), a second feed, an edge already run in",
                      .axisymmetric = true},
      .amplitude = {"amplitude_um", "A", "µm", 0.1, 0.0},
      .reading = since_start_m,
      .value = tool_running_in_value,
      .applies_to = is_face_height,
      .shape = ShapeSpec{.parameter = {"distance_m", "s0", "m", 1.0, 1e-2, 1e6},
                         .shape = {.parameter = 1, .logarithmic = true, .stepwise = false},
                         .derivative = tool_running_in_derivative,
                         .range = [](const Stations& stations) {
                           return transient_range(stations, distance_m_of);
                         }}});
}

}  // namespace slideway
