#include <algorithm>
#include <cmath>
#include <utility>

#include "../of_face.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr double kAside = 1.0;  // mm from the axis, where A is: there the values tell it for any d

// sqrt(r² + d²): of mm, without the care of std::hypot for what overflows.
double away(double r, double d) { return std::sqrt(r * r + d * d); }

// sqrt(r² + d²) - r without the cancellation at large r.
double rise(double r, double d) { return d * d / (away(r, d) + r); }

double chord_value(double r, double d) { return rise(r, d) / rise(kAside, d); }

double chord_derivative(double r, double d) {
  return d * (1.0 / away(r, d) - chord_value(r, d) / away(kAside, d)) / rise(kAside, d);
}

// Of A = z' (sqrt(1 mm² + d²) - 1 mm). A form the other way round is of no trace: below zero.
OfFace::Distance chord_distance(double of_slope) {
  constexpr double kNear = 1e-6;  // mm: no nearer, where the distance has no derivative
  const double distance =
      std::max(kNear, std::sqrt(std::abs(of_slope * (of_slope + 2.0 * kAside))));
  return {std::copysign(distance, of_slope), std::abs(of_slope + kAside) / distance};
}

}  // namespace

std::unique_ptr<Effect> make_chord(const Request& request) {
  request.accept_only({});
  SingleAmplitudeSpec spec{
      .description =
          {.name = "chord",
           .plain_name = "trace beside the diameter",
           .standard_name = "trace beside the diameter of the face (ISO 12781)",
           .formula =
               "z'(r) (sqrt(r² + d²) - r): A z'(r)/z'_rms (sqrt(r² + d²) - r) / "
               "(sqrt(1 mm² + d²) - 1 mm), z' the slope of the face as the carriages make it",
           .source =
               "the form z at the radius sqrt(r² + d²) that the stylus is at, less that at r, "
               "to first order; of a cone exactly",
           .cause = "the trace passes the centre of the workpiece at the distance d",
           .typical = "d is 0.01 to 0.5 mm: 2 to 100 nm at the centre of a face that slopes by 200 "
                      "µrad",
           .variable = IndependentVariable::radius,
           .confounded_with = "centre_height with h = d, exactly on a cone; speed_effect",
           .confounded_effects = {"centre_height", "speed_effect"},
           .separated_by = "A is the height 1 mm beside the axis, which goes with the slope of the "
                           "face; a parallel trace: the chord moves, a nub stays",
           .steep_at_centre = true,
           .of_face = true},
      .amplitude = {"height_um", "A", "µm", 0.01},
      .reading = radius_of,
      .value = chord_value,
      .applies_to = is_face_height,
      .shape = ShapeSpec{
          .parameter = {"distance_mm", "d", "mm", 0.05, 1e-4, 10.0},
          .shape = {.parameter = 1, .logarithmic = true, .stepwise = false, .may_begin = true},
          .derivative = chord_derivative,
          .range = distance_from_axis}};
  return std::make_unique<OfFace>(std::move(spec), request.range.face_slope, chord_distance);
}

}  // namespace slideway
