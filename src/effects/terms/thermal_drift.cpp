#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

// Nothing drifts before the cut starts; a trace longer than the cut would have negative times.
double since_start(const Stations& stations, Eigen::Index i) {
  return std::max(stations.time(i), 0.0);
}

double thermal_drift_value(double t, double tau) { return -std::expm1(-t / tau); }

double thermal_drift_derivative(double t, double tau) {
  return -std::exp(-t / tau) * t / (tau * tau);
}

}  // namespace

std::unique_ptr<Effect> make_thermal_drift(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description =
          {.name = "thermal_drift",
           .plain_name = "thermal drift",
           .standard_name = "thermal distortion in Z after a change of the heat input "
                            "(ISO 230-3)",
           .formula = "A (1 - exp(-t/τ))",
           .source = "ISO 230-3",
           .cause = "spindle, tool shank or workpiece warming up after the start; also the "
                    "axis shift of a spindle that was just run up",
           .typical = "0.05 to 1 µm; τ is 0.5 to 3 min for a tool shank, 1 to 10 min for "
                      "the workpiece, 10 to 90 min for spindle and column",
           .variable = IndependentVariable::time,
           .confounded_with = "the straightness polynomial on one face, tool_running_in "
                              "and tool_wear at one spindle speed, edge_roll_off if τ is "
                              "short",
           .confounded_effects = {"straightness", "tool_running_in", "tool_wear", "edge_roll_off"},
           .separated_by = "a second feed (the time scale on the face changes), a cut "
                           "outward (mirrored), a temperature log",
           .axisymmetric = true},
      .amplitude = {"amplitude_um", "A", "µm", 0.1},
      .reading = since_start,
      .value = thermal_drift_value,
      .applies_to = is_height,
      .shape = ShapeSpec{
          .parameter = {"time_constant_s", "τ", "s", 60.0, 1.0, 36000.0},
          .shape = {.parameter = 1, .logarithmic = true, .stepwise = false},
          .derivative = thermal_drift_derivative,
          .range = [](const Stations& stations) { return transient_range(stations, time_of); }}});
}

}  // namespace slideway
