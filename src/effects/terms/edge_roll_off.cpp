#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

// Distance from the rim, <= 0; a sample beyond the rim counts as on it.
double from_rim(const Stations& stations, Eigen::Index i) {
  return std::min(stations.radius(i) - *stations.setup().cut_radius_mm, 0.0);
}

double edge_roll_off_value(double distance, double width) { return std::exp(distance / width); }

double edge_roll_off_derivative(double distance, double width) {
  return -distance / (width * width) * std::exp(distance / width);
}

}  // namespace

std::unique_ptr<Effect> make_edge_roll_off(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "edge_roll_off",
                      .plain_name = "edge roll-off",
                      .standard_name = "edge of undefined shape at the rim (ISO 13715)",
                      .formula = "A exp((r - R)/w)",
                      .source = "empirical shape of a rim",
                      .cause = "the rim gives way, burrs, or is rounded where the tool enters",
                      .typical = "0.05 to 5 µm, w of 0.03 to 0.4 mm",
                      .variable = IndependentVariable::radius,
                      .confounded_with =
                          "a short thermal_drift or tool_running_in of an inward cut "
                          "at one feed",
                      .confounded_effects = {"thermal_drift", "tool_running_in"},
                      .separated_by =
                          "it stays at the same radii at every feed and in both cutting "
                          "directions",
                      .axisymmetric = true},
      .amplitude = {"amplitude_um", "A", "µm", 0.1},
      .reading = from_rim,
      .value = edge_roll_off_value,
      .applies_to = is_face_height,
      .needs_cut_radius = true,
      .shape = ShapeSpec{.parameter = {"width_mm", "w", "mm", 0.1, 1e-3, 100.0},
                         .shape = {.parameter = 1, .logarithmic = true, .stepwise = false},
                         .derivative = edge_roll_off_derivative,
                         .range = [](const Stations& stations) {
                           constexpr double kWidest = 0.1;  // of the radius
                           const double rim = *stations.setup().cut_radius_mm;
                           return std::pair{0.02, std::clamp(kWidest * rim, 1.0, 100.0)};
                         }}});
}

}  // namespace slideway
