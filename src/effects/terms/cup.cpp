#include "../clock_range.hpp"
#include "../linear_effect.hpp"
#include "../request.hpp"

namespace slideway {
namespace {

double value(const Stations& stations, Eigen::Index i, double) {
  const double ratio = stations.radius(i) / *stations.setup().cut_radius_mm;
  return ratio * ratio;
}

}  // namespace

std::unique_ptr<Effect> make_cup(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description =
          {.name = "cup",
           .standard_name = "axisymmetric flatness deviation, concave or convex (ISO 12781)",
           .formula = "A (r/R)²",
           .source = "plate bending under axisymmetric load",
           .cause = "spring-back after clamping, residual stress, the part still warm when "
                    "measured",
           .typical = "0.05 to 5 µm by clamping, 3 to 70 nm by residual stress",
           .clock = Clock::radius,
           .confounded_with = "b_2 of straightness (exactly), tool_wear at one feed "
                              "(exactly)",
           .separated_by = "measuring while still clamped, another clamping force; an "
                           "independent reading of the straightness; a second feed against "
                           "tool_wear"},
      .amplitude = {"sag_um", "A", "µm", 0.1},
      .value = value,
      .applies_to = is_face_height,
      .needs_cut_radius = true});
}

}  // namespace slideway
