#include "disagreement.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "slideway/identify/agreement.hpp"

namespace slideway {

Disagreement disagreement(const FittedModel& fitted, const std::vector<Noise>& of_each) {
  Disagreement out;
  const auto& [model, fit] = fitted;
  if (fit.linear.observations.size() < 2) return out;
  std::map<std::vector<std::string>, double> pairs;  // p-value of each, one for all its effects
  for (const ProfileCheck& check : check_profiles(model, fit, of_each))
    if (check.p_value) pairs[check.profiles] = *check.p_value;
  const auto count = static_cast<double>(pairs.size());
  std::set<std::vector<std::string>> disagree;
  for (const auto& [names, p] : pairs) {
    out.p_value = std::min(out.p_value, count * p);
    if (count * p <= model.gates.disagreement_p) disagree.insert(names);
  }
  out.odd_one = odd_profile(disagree);
  const std::vector<OddRepeat> odd = odd_repeats(fit.linear, model.gates);
  for (const OddRepeat& each : odd) out.p_value = std::min(out.p_value, each.p_value);
  if (odd.size() == 1) out.odd_one = fit.linear.observations[odd.front().profile]->profile->name;
  return out;
}

std::string disagreement_advice(const Disagreement& found) {
  const std::string who = found.odd_one.empty()
                              ? "the profiles disagree beyond their noise"
                              : "profile " + found.odd_one + " disagrees with the others";
  return who +
         ": check how each was cut and read (direction and start of the cut, centre, units); one "
         "that is wrong has role = \"holdout\"";
}

}  // namespace slideway
