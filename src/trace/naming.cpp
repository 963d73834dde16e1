#include "naming.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "heat.hpp"
#include "local_forms.hpp"
#include "process.hpp"
#include "structure.hpp"

namespace slideway {
namespace {

using Effects = std::vector<AcceptedEffect>;

constexpr std::size_t kAllSubsets = 3;  // of a larger set those that lack one name or all

/// The effects of a set that may not be there.
std::vector<std::size_t> questionable(const Effects& effects) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < effects.size(); ++i)
    if (!is_kinematic(*effects[i].candidate)) out.push_back(i);
  return out;
}

/// What a subset lacks of the members of a set, for every subset but the set itself.
std::vector<std::vector<std::size_t>> absences(const std::vector<std::size_t>& members) {
  std::vector<std::vector<std::size_t>> out;
  if (members.size() <= kAllSubsets) {
    for (std::uint32_t bits = 1; bits < (1u << members.size()); ++bits) {
      std::vector<std::size_t>& absent = out.emplace_back();
      for (std::size_t i = 0; i < members.size(); ++i)
        if (bits & (1u << i)) absent.push_back(members[i]);
    }
    return out;
  }
  for (const std::size_t i : members) out.push_back({i});
  out.push_back(members);
  return out;
}

/// A polynomial of the carriage of a higher degree: an unnamed process of the slide is the same way
/// in other words, and was its rival when it entered.
bool only_carriage(const Effects& effects, const std::vector<std::size_t>& which) {
  return std::ranges::all_of(
      which, [&](std::size_t i) { return effects[i].candidate->term.effect->is_carriage(); });
}

/// Whether these are one effect, by itself in each of several cuts: at one time, or after one
/// distance, it may be in all of them.
bool is_one_in_several(const Effects& effects, const std::vector<std::size_t>& which) {
  return which.size() > 1 && std::ranges::all_of(which, [&](std::size_t i) {
           const Candidate& candidate = *effects[i].candidate;
           return !candidate.term.profiles.empty() &&
                  candidate.effect_name() == effects[which.front()].candidate->effect_name();
         });
}

/// Whether nothing but the slide shows: a form of it is the way, whatever its shape.
bool shows_slide_only(const Linearisation& linear) {
  return std::ranges::all_of(linear.observations, [](const Observation* observation) {
    return observation->profile->setup.kind == Kind::slide;
  });
}

}  // namespace

std::vector<UnnamedRival> unnamed_rivals(ModelExtender& extender, const Effects& effects) {
  const Whitened& named = extender.search(effects).data;
  const FittedModel& with = extender.extended(effects);
  const std::vector<ProcessVariable> variables = process_variables(with.model, with.fit.linear);
  std::vector<ProcessVariable> but_slide = variables;
  std::erase_if(but_slide, [](const auto& each) { return each.symbol == kSlideSymbol; });
  std::vector<UnnamedRival> out;
  const std::vector<std::size_t> members = questionable(effects);
  for (const std::vector<std::size_t>& absent : absences(members)) {
    const FittedModel& fitted = extender.extended(all_but(effects, absent));
    const Linearisation& linear = fitted.fit.linear;
    const Whitened data(linear, named.noise(), named.undescribed());
    double gain = data.residual().squaredNorm() - named.residual().squaredNorm();
    for (const std::size_t i : absent) {
      const Candidate& candidate = *effects[i].candidate;
      gain -= penalty(named, candidate, candidate.amplitudes());
    }
    const bool is_way = only_carriage(effects, absent);
    const std::vector<ProcessVariable>& rivals = is_way ? but_slide : variables;
    const std::vector<Process> processes = best_processes(data, rivals);
    for (std::size_t v = 0; v < rivals.size(); ++v)
      out.push_back({rivals[v].symbol == kOfEachProfile ? "a process of each profile"
                                                        : "a process in " + rivals[v].symbol,
                     absent, true, 0.5 * gain - processes[v].log_evidence});
    out.push_back({"heat that lifts and tilts the slide", absent, false,
                   0.5 * gain - heat_lifts_and_tilts(fitted.model, data, linear)});
    if (is_way && shows_slide_only(linear)) continue;
    const auto add_local_form = [&](const std::string& name, const std::string& symbol) {
      out.push_back(
          {name, absent, false,
           0.5 * gain - local_forms(readings_of(fitted.model, linear, symbol), data, linear)});
    };
    if (absent.size() == 1 || absent.size() == members.size())
      add_local_form("a local form", kSlideSymbol);
    if (!is_one_in_several(effects, absent)) continue;
    for (const ProcessVariable& each : rivals)
      if (!each.of_each && each.symbol != kSlideSymbol &&
          each.profiles.size() == linear.observations.size())
        add_local_form("a local form in " + each.symbol, each.symbol);
  }
  return out;
}

double gain_over_process(ModelExtender& extender, const Effects& effects, std::size_t which) {
  const FittedModel& with = extender.extended(effects);
  const FittedModel& without = extender.extended(all_but(effects, which));
  const std::vector<Noise>& noise = with.fit.noise;
  const Whitened with_it(with.fit.linear, noise), without_it(without.fit.linear, noise);
  const Candidate& candidate = *effects[which].candidate;
  return 0.5 * (without_it.residual().squaredNorm() - with_it.residual().squaredNorm() -
                penalty(with_it, candidate, candidate.amplitudes())) +
         find_structure(with.model, with_it, with.fit.linear).process.log_evidence -
         find_structure(without.model, without_it, without.fit.linear).process.log_evidence;
}

}  // namespace slideway
