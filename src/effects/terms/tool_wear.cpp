#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {

std::unique_ptr<Effect> make_tool_wear(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description =
          {.name = "tool_wear",
           .plain_name = "tool wear",
           .standard_name = "flank wear of the tool, steady phase (ISO 3685)",
           .formula = "w s",
           .source = "s = π (R² - r²)/f inward, π r²/f outward, f the feed per turn",
           .cause = "the edge recedes in proportion to the distance it has cut; the face "
                    "rises along the cut",
           .typical = "far below 1 nm per 10 m for diamond in aluminium, 10 to 200 nm for "
                      "carbide or a damaged edge",
           .variable = IndependentVariable::distance,
           .confounded_with = "cup and b_2 of straightness at one feed (exactly r²), "
                              "thermal_drift",
           .confounded_effects = {"cup", "straightness", "thermal_drift"},
           .separated_by = "a second feed or spindle speed (distance goes with rpm/feed, "
                           "thermal drift does not know the rpm), the other cutting "
                           "direction",
           .axisymmetric = true},
      .amplitude = {"rate_um_per_m", "w", "µm/m", 0.01, 0.0},
      .unit = kMicrometre / kMetre,
      .reading = [](const Stations& stations, Eigen::Index i) { return stations.distance(i); },
      .applies_to = is_face_height});
}

}  // namespace slideway
