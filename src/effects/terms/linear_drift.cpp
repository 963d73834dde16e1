#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {

std::unique_ptr<Effect> make_linear_drift(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "linear_drift",
                      .plain_name = "steady drift",
                      .standard_name = "thermal distortion in Z at a constant rate (ISO 230-3)",
                      .formula = "a t",
                      .source = "ISO 230-3",
                      .cause = "slow warming of spindle, column or room, seen over a short cut",
                      .typical = "0.2 to 100 nm/min",
                      .variable = IndependentVariable::time,
                      .confounded_with = "squareness and tilt at one feed (exactly)",
                      .confounded_effects = {"squareness"},
                      .separated_by =
                          "a second feed: the slope on the face goes with 1/feed; a cut "
                          "in the other direction changes its sign",
                      .axisymmetric = true},
      .amplitude = {"rate_um_per_min", "a", "µm/min", 0.01},
      .unit = kMicrometre / kMinute,
      .reading = time_of,
      .applies_to = is_height});
}

}  // namespace slideway
