#include "modulation.hpp"

#include <algorithm>

namespace slideway {
namespace {

bool lies_beside(const LineBand& line, const LineBand& other, const Gates& gates) {
  const double distance = std::max({other.low - line.high, line.low - other.high, 0.0});
  return distance <= std::min(gates.modulation_widths, gates.modulation_share * line.low);
}

bool lie_beside(const std::vector<LineBand>& lines, const std::vector<LineBand>& others,
                const Gates& gates) {
  return std::ranges::all_of(lines, [&](const LineBand& line) {
    return std::ranges::any_of(
        others, [&](const LineBand& other) { return lies_beside(line, other, gates); });
  });
}

}  // namespace

std::string modulated_effect(const Model& model, const Eigen::VectorXd& shapes,
                             const Refined& refined) {
  const ModelTerm& own = refined.candidate->term;
  const auto is_modulated = [&](const ModelTerm& term) {
    bool shown = false;
    for (const Observation* observation : fitted_observations(model)) {
      const Profile& profile = *observation->profile;
      if (!own.effect->applies_to(profile.setup)) continue;
      if (!term.effect->applies_to(profile.setup)) return false;
      const Stations stations = profile.stations(model.machine);
      const auto lines = own.effect->lines(stations, refined.shape);
      if (lines.empty() ||
          !lie_beside(lines, term.effect->lines(stations, shapes_of(term, shapes)), model.gates))
        return false;
      shown = true;
    }
    return shown && term.name != own.name;
  };
  const auto found = std::ranges::find_if(model.terms, is_modulated);
  return found == model.terms.end() ? "" : found->name;
}

}  // namespace slideway
