#include "own_noise.hpp"

#include <algorithm>

#include "disagreement.hpp"
#include "process.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/lack_of_fit.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

bool may_be_asked(const FittedModel& fitted, const std::vector<AcceptedEffect>& effects) {
  const auto& [model, fit] = fitted;
  const auto is_face = [](const Observation* each) {
    return each->profile->setup.kind == Kind::face;
  };
  return std::ranges::all_of(fit.linear.observations, is_face) &&
         static_cast<double>(fit.linear.observations.size()) >=
             model.gates.profiles_for_slow_noise &&
         fit.linear.curve_rows == 0 && check_repeats(fit.linear, model.gates).empty() &&
         std::ranges::all_of(effects,
                             [](const auto& each) { return is_kinematic(*each.candidate); });
}

}  // namespace

std::optional<std::vector<Noise>> noise_of_its_own(ModelExtender& extender,
                                                   const std::vector<AcceptedEffect>& effects) {
  const FittedModel& fitted = extender.extended(effects);
  const auto& [model, fit] = fitted;
  const Gates& gates = model.gates;
  if (!may_be_asked(fitted, effects)) return std::nullopt;
  const Whitened& beside = extender.search(effects).data;
  std::vector<Noise> noise = noise_if_complete(fit.linear, beside.noise(), gates);
  if (lack_of_fit(fit.linear, noise, gates).significant(gates) ||
      disagreement(fitted, noise).p_value < gates.disagreement_p)
    return std::nullopt;
  const Whitened data(fit.linear, noise, beside.undescribed());
  for (const ProcessVariable& variable : process_variables(model, fit.linear))
    if (2.0 * best_process(data, variable).log_evidence > gates.delta_bic) return std::nullopt;
  for (const Finding& each : search(data, extender.candidates_beside(effects)))
    if (!is_kinematic(*each.candidate) && each.delta_bic < -gates.left_over_bic)
      return std::nullopt;
  return noise;
}

}  // namespace slideway
