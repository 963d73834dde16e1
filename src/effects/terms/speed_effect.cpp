#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

// The power law ends where the cutting speed is lost in the edge radius.
constexpr double kSmallestRadius = 0.02;  // mm

double log_speed_ratio(const Stations& stations, Eigen::Index i) {
  return std::log(std::max(stations.radius(i), kSmallestRadius) / *stations.setup().cut_radius_mm);
}

double speed_effect_value(double log_ratio, double exponent) {
  return std::expm1(-exponent * log_ratio);
}

double speed_effect_derivative(double log_ratio, double exponent) {
  return -log_ratio * std::exp(-exponent * log_ratio);
}

}  // namespace

std::unique_ptr<Effect> make_speed_effect(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "speed_effect",
                      .plain_name = "effect of cutting speed",
                      .standard_name = "deflection by the cutting force, its dependence on the "
                                       "cutting speed",
                      .formula = "A ((max(r, 0.02 mm)/R)^-m - 1)",
                      .source = "force law F ~ v^-m with v = 2π r n",
                      .cause = "the cutting speed falls to zero at the centre: the force grows and "
                               "lifts the tool, or pulls it in (A < 0); chips build up on the edge",
                      .typical = "1 to 40 nm over the face, m of 0.1 to 0.5",
                      .variable = IndependentVariable::radius,
                      .confounded_with = "centre_height and everything singular at the centre",
                      .confounded_effects = {"centre_height"},
                      .separated_by = "a spring pass (no depth of cut, no force), a second feed "
                                      "(force grows with about f^0.7)",
                      .steep_at_centre = true,
                      .axisymmetric = true},
      .amplitude = {"amplitude_um", "A", "µm", 0.01},
      .reading = log_speed_ratio,
      .value = speed_effect_value,
      .applies_to = is_face_height,
      .needs_cut_radius = true,
      .shape = ShapeSpec{.parameter = {"exponent", "m", "1", 0.2, 0.01, 1.0},
                         .shape = {.parameter = 1, .logarithmic = false, .stepwise = false},
                         .derivative = speed_effect_derivative,
                         .range = [](const Stations&) {
                           return std::pair{0.05, 0.6};
                         }}});
}

}  // namespace slideway
