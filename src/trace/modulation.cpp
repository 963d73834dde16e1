#include "modulation.hpp"

#include <algorithm>
#include <cmath>

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

/// Distance from the nearest whole number: a rate in cycles a sample as sampling folds it.
double folded(double cycles) { return std::abs(cycles - std::round(cycles)); }

/// Whether a line of one face lies where sampling folds a harmonic of its feed marks to, nearer
/// than the gate modulation_widths.
bool is_alias_of_feed_marks(const Profile& profile, const std::vector<LineBand>& lines,
                            const Gates& gates) {
  constexpr int kHarmonics = 6;
  const Setup& setup = profile.setup;
  const auto samples = static_cast<double>(profile.positions.size());
  if (setup.kind != Kind::face || !setup.feed_mm_per_min || !setup.spindle_rpm || samples < 2.0)
    return false;
  const double trace = setup.last_mm - setup.first_mm, spacing = trace / (samples - 1.0);
  const double radius = std::max(setup.last_mm - setup.center_mm, setup.center_mm - setup.first_mm);
  const double marks = spacing * *setup.spindle_rpm / *setup.feed_mm_per_min;  // cycles a sample
  const double width = gates.modulation_widths / samples;
  return std::ranges::all_of(lines, [&](const LineBand& line) {
    for (const double extent : {radius, trace})
      for (int m = 1; m <= kHarmonics; ++m)
        if (std::abs(folded(line.low * spacing / extent) - folded(m * marks)) <= width) return true;
    return false;
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
  if (found != model.terms.end()) return found->name;
  if (own.profiles.size() != 1) return "";
  for (const Observation* observation : fitted_observations(model)) {
    const Profile& profile = *observation->profile;
    if (!own.acts_on(profile)) continue;
    const auto lines = own.effect->lines(profile.stations(model.machine), refined.shape);
    if (!lines.empty() && is_alias_of_feed_marks(profile, lines, model.gates))
      return "the feed marks, folded by sampling";
  }
  return "";
}

}  // namespace slideway
