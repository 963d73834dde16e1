#include "naming.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "local_forms.hpp"
#include "process.hpp"

namespace slideway {
namespace {

using Effects = std::vector<AcceptedEffect>;

constexpr std::size_t kAllSubsets = 3;  // of a larger set those that lack one name or all

/// Members of a set that a subset lacks, for every subset but the set itself.
std::vector<std::vector<std::size_t>> absences(std::size_t members) {
  std::vector<std::vector<std::size_t>> out;
  if (members <= kAllSubsets) {
    for (std::uint32_t bits = 1; bits < (1u << members); ++bits) {
      std::vector<std::size_t>& absent = out.emplace_back();
      for (std::size_t i = 0; i < members; ++i)
        if (bits & (1u << i)) absent.push_back(i);
    }
    return out;
  }
  for (std::size_t i = 0; i < members; ++i) out.push_back({i});
  std::vector<std::size_t>& all = out.emplace_back();
  for (std::size_t i = 0; i < members; ++i) all.push_back(i);
  return out;
}

/// A polynomial of the carriage of a higher degree: an unnamed process of the slide is the same way
/// in other words, and was its rival when it entered.
bool only_carriage(const Effects& effects, const std::vector<std::size_t>& which) {
  return std::ranges::all_of(
      which, [&](std::size_t i) { return effects[i].candidate->term.effect->is_carriage(); });
}

/// Whether nothing but the slide shows: a form of it is the way, whatever its shape.
bool shows_slide_only(const Linearisation& linear) {
  return std::ranges::all_of(linear.observations, [](const Observation* observation) {
    return observation->profile->setup.kind == Kind::slide;
  });
}

}  // namespace

Standing standing(ModelExtender& extender, const Effects& effects, const Gates& gates) {
  const Whitened& named = extender.search(effects).data;
  const FittedModel& with = extender.extended(effects);
  const std::vector<ProcessVariable> variables = process_variables(with.model, with.fit.linear);
  Standing out;
  for (const std::vector<std::size_t>& absent : absences(effects.size())) {
    const FittedModel& fitted = extender.extended(all_but(effects, absent));
    const Linearisation& linear = fitted.fit.linear;
    const Whitened data(linear, named.noise(), named.undescribed());
    double gain = data.residual().squaredNorm() - named.residual().squaredNorm();
    for (const std::size_t i : absent) {
      const Candidate& candidate = *effects[i].candidate;
      gain -= penalty(named, candidate, candidate.amplitudes());
    }
    const auto hold_against = [&](double log_evidence, const std::string& rival) {
      const double margin = 0.5 * gain - log_evidence;
      if (margin < out.margin) out = {margin, rival, absent};
    };
    const bool is_way = only_carriage(effects, absent);
    for (const ProcessVariable& variable : variables) {
      if (is_way && variable.symbol == kSlideSymbol) continue;
      hold_against(best_process(data, linear, variable).log_evidence + gates.process_margin,
                   "a process in " + variable.symbol);
    }
    if (is_way && shows_slide_only(linear)) continue;
    if (absent.size() == 1 || absent.size() == effects.size())
      hold_against(local_forms(fitted.model, data, linear) + gates.local_form_margin,
                   "a local form");
  }
  return out;
}

}  // namespace slideway
