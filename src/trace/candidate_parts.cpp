#include "candidate_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "slideway/effects/catalogue.hpp"

namespace slideway {
namespace {

/// Whether traces of one surface must show it together: alike, as they are of one face, or because
/// only several of them tell it from others. So it is, too, with what one trace has in common with
/// a form of the face, where the surface has the traces that show such a form.
bool is_of_surface(const Effect& effect, const std::vector<const Setup*>& traces) {
  const Description& own = effect.description();
  const auto takes_several = [&](const Effect& each) {
    return !each.lacking_together({traces.front()}).empty();
  };
  return own.axisymmetric || takes_several(effect) ||
         std::ranges::any_of(own.confounded_effects, [&](const std::string& name) {
           const Effect& other = specimen(name);
           return takes_several(other) && other.lacking_together(traces).empty();
         });
}

/// The fitted profiles that an effect acts on, by their places, in groups: the traces of a surface
/// that must show it together, else each alone.
std::vector<std::vector<std::size_t>> groups_of(const Model& model, const ModelTerm& term) {
  std::map<std::string, std::vector<std::size_t>> surfaces;
  std::vector<std::vector<std::size_t>> out;
  const std::vector<const Observation*> observations = fitted_observations(model);
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Profile& profile = *observations[i]->profile;
    if (!term.acts_on(profile)) continue;
    if (profile.surface && profile.setup.kind == Kind::face)
      surfaces[*profile.surface].push_back(i);
    else
      out.push_back({i});
  }
  for (const auto& [surface, profiles] : surfaces) {
    std::vector<const Setup*> traces;
    for (const std::size_t i : profiles) traces.push_back(&observations[i]->profile->setup);
    if (is_of_surface(*term.effect, traces))
      out.push_back(profiles);
    else
      for (const std::size_t i : profiles) out.push_back({i});
  }
  std::ranges::sort(out);
  return out;
}

}  // namespace

std::vector<Candidate> in_parts(const Model& model, const Candidate& whole) {
  const ModelTerm& term = whole.term;
  if (term.effect->is_carriage() || !term.profiles.empty() || whole.raises_degree) return {};
  const std::vector<const Observation*> observations = fitted_observations(model);
  std::vector<RowRange> rows;
  for (const Observation* observation : observations)
    rows.push_back({rows.empty() ? 0 : rows.back().end(), observation->values.size()});
  const std::vector<std::vector<std::size_t>> groups = groups_of(model, term);
  std::vector<Candidate> out;
  if (groups.size() < 2) return out;
  for (const std::vector<std::size_t>& group : groups) {
    std::vector<const Setup*> setups;
    for (const std::size_t i : group) setups.push_back(&observations[i]->profile->setup);
    if (!term.effect->lacking_together(setups).empty()) continue;
    Candidate& part = out.emplace_back(whole);
    part.part = group;
    part.rows.clear();
    for (const std::size_t i : group) {
      part.term.profiles.push_back(observations[i]->profile->name);
      if (!part.rows.empty() && part.rows.back().end() == rows[i].first)
        part.rows.back().count += rows[i].count;
      else
        part.rows.push_back(rows[i]);
    }
    part.options.profiles = part.term.profiles;
    part.term.name = term_name(term.name, part.term.profiles);
    part.choice = 2.0 * std::log(static_cast<double>(groups.size()));
  }
  return out;
}

bool has_forms_of_its_own(const Model& model, const Candidate& whole,
                          const std::vector<Candidate>& parts) {
  return !parts.empty() &&
         std::ranges::all_of(fitted_observations(model), [&](const Observation* observation) {
           const Profile& profile = *observation->profile;
           return !whole.term.acts_on(profile) ||
                  (!whole.term.effect->lacking_together({&profile.setup}).empty() &&
                   std::ranges::any_of(
                       parts, [&](const Candidate& part) { return part.term.acts_on(profile); }));
         });
}

}  // namespace slideway
