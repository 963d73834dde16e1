#include <algorithm>
#include <cmath>
#include <utility>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

constexpr double kFarthest = 0.1;  // of the radius of the cut

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
  const double farthest = kFarthest * *stations.setup().cut_radius_mm;
  return {-farthest, farthest};
}

}  // namespace

std::unique_ptr<Effect> make_centring(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description =
          {.name = "centring",
           .plain_name = "trace off centre",
           .standard_name = "trace off the centre of the face (ISO 12781)",
           .formula = "A (|X| - |X - X0|)/X0; A = -Θ X0 of a face with the slope Θ: A sgn X "
                      "where |X| > |X0|",
           .source = "the form at |X - X0| less that at |X|: of a cone Θ r this, of a parabola a "
                     "tilt, which levelling takes",
           .cause = "center_mm is not where the spindle axis lies in the trace",
           .typical = "X0 is 1 to 50 µm, up to 1 mm where a trace was trimmed by hand: 10 nm at "
                      "50 µm on a face that slopes by 200 µrad",
           .variable = IndependentVariable::trace,
           .confounded_with = "centre_step if X0 is not resolved",
           .confounded_effects = {"centre_step"},
           .separated_by = "center_mm from the nub or from the edges of the face; -A/X0 is the "
                           "slope of the face, whose squareness tells it; traces at three or more "
                           "azimuths: a step of the spindle goes with the azimuth"},
      .amplitude = {"height_um", "A", "µm", 0.01},
      .reading = [](const Stations& stations, Eigen::Index i) { return stations.trace(i); },
      .value = centring_value,
      .applies_to = crosses_the_axis,
      .needs_cut_radius = true,
      .shape = ShapeSpec{.parameter = {"offset_mm", "X0", "mm", 0.05, -1e3, 1e3},
                         .shape = {.parameter = 1, .logarithmic = false, .stepwise = false},
                         .derivative = centring_derivative,
                         .range = centring_search}});
}

}  // namespace slideway
