#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

// (sqrt(r² + h²) - r)/h without the cancellation at large r.
double centre_height_value(double r, double h) { return h / (std::hypot(r, h) + r); }

double centre_height_derivative(double r, double h) {
  const double hypotenuse = std::hypot(r, h);
  return r / (hypotenuse * (hypotenuse + r));
}

}  // namespace

std::unique_ptr<Effect> make_centre_height(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "centre_height",
                      .plain_name = "tool off centre height",
                      .standard_name = "offset of the tool edge from the spindle axis in Y",
                      .formula = "A (sqrt(r² + h²) - r)/h",
                      .source = "geometry of a cut that passes the axis at the distance h",
                      .cause = "the tool edge is too high or too low and passes the axis; a trace "
                               "beside the diameter looks the same",
                      .typical = "h is 1 to 50 µm; the nub at the centre is at most as high as the "
                                 "depth of cut",
                      .variable = IndependentVariable::radius,
                      .confounded_with =
                          "speed_effect; chord, a trace off the diameter by h, exactly",
                      .confounded_effects = {"speed_effect", "chord"},
                      .separated_by =
                          "parallel traces at known spacing, a microscope: a nub is there "
                          "or not",
                      .steep_at_centre = true,
                      .axisymmetric = true},
      .amplitude = {"amplitude_um", "A", "µm", 0.1},
      .reading = radius_of,
      .value = centre_height_value,
      .applies_to = is_face_height,
      .shape = ShapeSpec{.parameter = {"height_mm", "h", "mm", 0.05, 1e-4, 10.0},
                         .shape = {.parameter = 1, .logarithmic = true, .stepwise = false},
                         .derivative = centre_height_derivative,
                         .range = distance_from_axis}});
}

}  // namespace slideway
