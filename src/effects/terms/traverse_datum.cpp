#include <algorithm>
#include <cmath>

#include "../linear_effect.hpp"
#include "../request.hpp"
#include "../variable_range.hpp"

namespace slideway {
namespace {

double relative_position(const Stations& stations, Eigen::Index i) {
  const Setup& setup = stations.setup();
  const double reach = std::max(std::abs(setup.first_mm - setup.center_mm),
                                std::abs(setup.last_mm - setup.center_mm));
  return reach > 0.0 ? stations.trace(i) / reach : 0.0;
}

}  // namespace

std::unique_ptr<Effect> make_traverse_datum(const Request& request) {
  request.accept_only({});
  return std::make_unique<SingleAmplitude>(SingleAmplitudeSpec{
      .description = {.name = "traverse_datum",
                      .plain_name = "bow of the traverse unit",
                      .standard_name = "straightness of the traverse unit (ISO 3274), odd part",
                      .formula = "A (X/X_max)³, X_max the largest |X| of the trace",
                      .source = "guide profile of the profilometer",
                      .cause = "the instrument's own guide is not straight; a three-jaw clamping "
                               "(trefoil) gives the same odd cubic on a diameter",
                      .typical = "5 to 50 nm over 20 mm",
                      .variable = IndependentVariable::trace,
                      .confounded_with = "b_3 of straightness on a radius; three chucking_lobes at "
                                         "one azimuth",
                      .confounded_effects = {"straightness", "chucking_lobes"},
                      .separated_by =
                          "turning the part by 180° on the instrument (the datum stays), "
                          "a trace at another azimuth (the trefoil changes), a trace over "
                          "the diameter (odd against even)"},
      .amplitude = {"amplitude_um", "A", "µm", 0.01},
      .reading = relative_position,
      .value = [](double ratio, double) { return ratio * ratio * ratio; },
      .applies_to = is_face_height});
}

}  // namespace slideway
