#include <algorithm>
#include <cmath>
#include <utility>

#include "../of_face.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr double kFarthestFromAxis = 0.1;  // of the radius of the cut

// (|x| - |x - off|)/off is sgn x outside a ramp between 0 and the offset.
double centring_value(double x, double off) {
  if (off == 0.0) return x > 0.0 ? 1.0 : x < 0.0 ? -1.0 : 0.0;
  return std::clamp((2.0 * x - off) / std::abs(off), -1.0, 1.0);
}

double centring_derivative(double x, double off) {
  const bool on_ramp = off != 0.0 && std::abs(2.0 * x - off) < std::abs(off);
  return on_ramp ? -2.0 * x / (off * std::abs(off)) : 0.0;
}

std::pair<double, double> centring_search(const Stations& stations) {
  const double farthest = kFarthestFromAxis * *stations.setup().cut_radius_mm;
  return {-farthest, farthest};
}

// A step of the height A = -X0 z'.
OfFace::Distance centring_distance(double of_slope) { return {-of_slope, -1.0}; }

}  // namespace

std::unique_ptr<Effect> make_centring(const Request& request) {
  request.accept_only({});
  SingleAmplitudeSpec spec{
      .description =
          {.name = "centring",
           .plain_name = "trace off centre",
           .standard_name = "trace off the centre of the face (ISO 12781)",
           .formula = "-X0 z'(r) sgn X: A z'(r)/z'_rms (|X| - |X - X0|)/X0, A = -X0 z'_rms, z' the "
                      "slope of the face as the carriages make it",
           .source = "the form z at |X - X0| less that at |X|, to first order; of a cone exactly",
           .cause = "center_mm is not where the spindle axis lies in the trace",
           .typical = "X0 is 1 to 50 µm, up to 1 mm where a trace was trimmed by hand: 10 nm at "
                      "50 µm on a face that slopes by 200 µrad",
           .variable = IndependentVariable::trace,
           .confounded_with = "centre_step if X0 is not resolved",
           .confounded_effects = {"centre_step"},
           .separated_by =
               "center_mm from the nub or from the edges of the face; traces at three or "
               "more azimuths: a step of the spindle goes with the azimuth",
           .of_face = true},
      .amplitude = {"height_um", "A", "µm", 0.01},
      .reading = [](const Stations& stations, Eigen::Index i) { return stations.trace(i); },
      .value = centring_value,
      .applies_to = crosses_the_axis,
      .needs_cut_radius = true,
      .shape = ShapeSpec{.parameter = {"offset_mm", "X0", "mm", 0.05, -1e3, 1e3},
                         .shape = {.parameter = 1, .logarithmic = false, .stepwise = false},
                         .derivative = centring_derivative,
                         .range = centring_search}};
  return std::make_unique<OfFace>(std::move(spec), request.range.face_slope, centring_distance);
}

}  // namespace slideway
