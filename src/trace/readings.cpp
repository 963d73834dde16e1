#include "readings.hpp"

#include <algorithm>
#include <set>

#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

bool reads_slide(const Observation* observation) {
  return observation->profile->setup.kind == Kind::slide;
}

bool has_effect(const Model& model, const std::string& effect) {
  return std::ranges::any_of(model.terms, [&](const ModelTerm& term) {
    return term.effect->description().name == effect;
  });
}

std::vector<std::string> errors_of_readings(const Model& model) {
  const auto observations = fitted_observations(model);
  const bool beside_faces = !std::ranges::all_of(observations, reads_slide);
  std::set<Quantity> quantities;
  std::set<bool> reversed, falls;  // of a drift, over the slide
  for (const Observation* each : observations) {
    if (!reads_slide(each)) continue;
    const Setup& setup = each->profile->setup;
    quantities.insert(setup.quantity);
    reversed.insert(setup.reversed);
    falls.insert((travel_direction(setup) == CutDirection::inward) != setup.reversed);
  }
  std::vector<std::string> out;
  for (const std::string& name : effect_names()) {
    const Description& effect = specimen(name).description();
    const bool is_drift = quantities == std::set{Quantity::slope} && falls.size() == 1 &&
                          is_drift_of_instrument(effect),
               is_datum = beside_faces && quantities == std::set{Quantity::height} &&
                          reversed.size() == 1 && effect.of_instrument &&
                          effect.variable == IndependentVariable::slide;
    if ((is_drift || is_datum) && !has_effect(model, name)) out.push_back(name);
  }
  return out;
}

}  // namespace slideway
