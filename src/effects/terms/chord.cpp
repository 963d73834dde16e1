#include <cmath>
#include <utility>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr double kSteepest = 1e5;  // µm/m: a tenth is a cone, no face

// sqrt(r² + d²) - r without the cancellation at large r.
double chord_value(double r, double d) { return d * d / (std::hypot(r, d) + r); }

double chord_derivative(double r, double d) { return d / std::hypot(r, d); }

}  // namespace

std::unique_ptr<Effect> make_chord(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description =
          {.name = "chord",
           .plain_name = "trace beside the diameter",
           .standard_name = "trace beside the diameter of the face (ISO 12781)",
           .formula = "Θ (sqrt(r² + d²) - r)",
           .source = "the form z at the radius sqrt(r² + d²) that the stylus is at, instead of r; "
                     "of a cone Θ r, to which a squareness turns the face",
           .cause = "the trace passes the centre of the workpiece at the distance d",
           .typical = "d is 0.01 to 0.5 mm, Θ the slope of the face: 2 to 100 nm at the centre",
           .variable = IndependentVariable::radius,
           .confounded_with = "centre_height, exactly, with A = Θ d and h = d; speed_effect",
           .confounded_effects = {"centre_height", "speed_effect"},
           .separated_by = "Θ is the slope of the face, whose squareness tells it; a parallel "
                           "trace: the chord moves, a nub stays",
           .steep_at_centre = true},
      .amplitude = {"slope_um_per_m", "Θ", "µm/m", 10.0, -kSteepest, kSteepest},
      .unit = kMicrometre / kMetre,
      .reading = radius_of,
      .value = chord_value,
      .applies_to = is_face_height,
      .shape = ShapeSpec{.parameter = {"distance_mm", "d", "mm", 0.05, 1e-4, 10.0},
                         .shape = {.parameter = 1, .logarithmic = true, .stepwise = false},
                         .derivative = chord_derivative,
                         .range = distance_from_axis}});
}

}  // namespace slideway
