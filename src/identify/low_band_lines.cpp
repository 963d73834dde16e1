#include "slideway/identify/low_band_lines.hpp"

#include <algorithm>

namespace slideway {

double cycles_along(const Setup& setup, const Effect& effect, const LineBand& line) {
  const IndependentVariable variable = effect.description().variable;
  if (setup.kind != Kind::face || variable == IndependentVariable::trace ||
      variable == IndependentVariable::measuring_time)
    return line.low;
  const double radius = std::max(setup.last_mm - setup.center_mm, setup.center_mm - setup.first_mm);
  return line.low * (setup.last_mm - setup.first_mm) / radius;
}

bool is_too_fine(const Model& model, const ModelTerm& term, std::span<const double> shape,
                 const Observation& observation) {
  constexpr double kWidth = 1.0;  // of a line, cycles
  const Effect& effect = *term.effect;
  const Profile& profile = *observation.profile;
  const double cycles =
      static_cast<double>(observation.values.size() - 1) / model.gates.values_per_cycle + kWidth;
  return std::ranges::any_of(
      effect.lines(profile.stations(model.machine), shape),
      [&](const LineBand& line) { return cycles_along(profile.setup, effect, line) > cycles; });
}

bool is_too_fine(const Model& model, const ModelTerm& term, std::span<const double> shape,
                 std::span<const Observation* const> observations) {
  return std::ranges::any_of(observations, [&](const Observation* each) {
    return term.acts_on(*each->profile) && is_too_fine(model, term, shape, *each);
  });
}

}  // namespace slideway
