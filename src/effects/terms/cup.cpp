#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

double relative_radius(const Stations& stations, Eigen::Index i) {
  return stations.radius(i) / *stations.setup().cut_radius_mm;
}

}  // namespace

std::unique_ptr<Effect> make_cup(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description =
          {.name = "cup",
           .plain_name = "cupped workpiece",
           .standard_name = "axisymmetric flatness deviation, concave or convex (ISO 12781)",
           .formula = "A (r/R)²",
           .source = "plate bending under axisymmetric load",
           .cause = "spring-back after clamping, residual stress, the part still warm when "
                    "measured",
           .typical = "0.05 to 5 µm by clamping, 3 to 70 nm by residual stress",
           .variable = IndependentVariable::radius,
           .confounded_with = "b_2 of straightness (exactly), tool_wear at one feed "
                              "(exactly)",
           .confounded_effects = {"straightness", "tool_wear"},
           .separated_by = "measuring while still clamped, another clamping force; an "
                           "independent reading of the straightness; a second feed against "
                           "tool_wear",
           .axisymmetric = true},
      .amplitude = {"sag_um", "A", "µm", 0.1},
      .reading = relative_radius,
      .value = [](double ratio, double) { return ratio * ratio; },
      .applies_to = is_face_height,
      .needs_cut_radius = true});
}

}  // namespace slideway
