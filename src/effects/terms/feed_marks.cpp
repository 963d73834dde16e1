#include <cmath>

#include "../clock_range.hpp"
#include "../linear_effect.hpp"
#include "../request.hpp"

namespace slideway {
namespace {

// Parabola of the tool nose in each groove, 4u² - 1/3 with u in [-1/2, 1/2] across the groove and
// mean zero. Groove centres lie at whole turns after the start of this cut: r = R - i f inward,
// r = i f outward, whatever the clock showed when it started.
double value(const Stations& stations, Eigen::Index i, double) {
  const Setup& setup = stations.setup();
  const double turns = stations.revolution(i) - setup.start_s * *setup.spindle_rpm / kMinute;
  const double u = turns - std::round(turns);
  return 4.0 * u * u - 1.0 / 3.0;
}

}  // namespace

std::unique_ptr<Effect> make_feed_marks(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "feed_marks",
                      .standard_name = "kinematic roughness, scallop height f²/(8 r_ε)",
                      .formula = "A (4u² - 1/3), u in [-1/2, 1/2] across each groove of width f",
                      .source = "A = f²/(8 r_ε) for nose radius r_ε and feed per turn f",
                      .cause = "the nose of the tool leaves one groove per turn",
                      .typical =
                          "8 to 83 nm at 18 µm per turn, 0.1 to 1.3 µm at 73 µm per turn (nose "
                          "radius 5 to 0.5 mm)",
                      .clock = Clock::revolution,
                      .confounded_with =
                          "nothing if the grooves are resolved; averaged over blocks "
                          "of a similar width it returns as a long alias",
                      .separated_by = "its period is exactly the feed per turn and its height goes "
                                      "with the square of the feed"},
      .amplitude = {"amplitude_um", "A", "µm", 0.1},
      .value = value,
      .applies_to = is_face_height});
}

}  // namespace slideway
