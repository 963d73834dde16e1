#include "modulation.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/identify/low_band_lines.hpp"

namespace slideway {
namespace {

constexpr double kOtherFeed = 1.1;  // marks a fifth deeper

bool lies_beside(const LineBand& line, const LineBand& other, const Gates& gates) {
  const double distance = std::max({other.low - line.high, line.low - other.high, 0.0});
  return distance <= std::min(gates.modulation_widths, gates.modulation_share * line.low);
}

/// @param order  of the harmonic of the others' rates
bool lie_beside(const std::vector<LineBand>& lines, const std::vector<LineBand>& others,
                double order, const Gates& gates) {
  return std::ranges::all_of(lines, [&](const LineBand& line) {
    return std::ranges::any_of(others, [&](const LineBand& other) {
      return lies_beside(line, {order * other.low, order * other.high}, gates);
    });
  });
}

/// Distance from the nearest whole number: a rate in cycles a sample as sampling folds it.
double folded(double cycles) { return std::abs(cycles - std::round(cycles)); }

/// Amplitude of the wave whose root mean square the effect has over a profile, mm.
double amplitude_on(const Model& model, const Refined& refined, const Profile& profile) {
  const Eigen::VectorXd signal = effect_signal(model, refined.candidate->term, profile,
                                               refined.projection.amplitudes, refined.shape);
  return std::sqrt(2.0 * signal.squaredNorm() / static_cast<double>(signal.size()));
}

/// Largest amplitude, mm, that feed marks can have where the lines of an effect in one face lie:
/// that of the lowest harmonic that is folded there, nearer than the gate folded_widths. Infinite
/// where the nose is not known, 0 where no harmonic is near.
double largest_mark_at(const Profile& profile, const Effect& effect,
                       const std::vector<LineBand>& lines, double samples_a_value,
                       const Gates& gates) {
  double out = INFINITY;
  for (const LineBand& line : lines) {
    const auto mark =
        mark_at(profile, cycles_along(profile.setup, effect, line), gates, samples_a_value);
    out = std::min(out, mark ? largest_feed_mark(profile.setup, *mark).value_or(INFINITY) : 0.0);
  }
  return out;
}

/// How much of its square a profile's white residual loses without what an effect takes of it.
double gain_in(const Whitened& data, const Eigen::VectorXd& fitted, std::size_t profile) {
  const auto own = fitted.segment(data.first_row(profile), data.count(profile));
  return 2.0 * own.dot(data.residual().segment(data.first_row(profile), data.count(profile))) -
         own.squaredNorm();
}

/// Whether cuts of different feeds show a wave for certain, and one serves all cuts as well as one
/// of its own in each would. Feed marks of another feed are of another depth, f²/(8 r), and begin
/// elsewhere.
bool is_one_wave(const std::vector<const Observation*>& observations, const Whitened& data,
                 const Refined& refined, const Eigen::VectorXd& fitted, const Gates& gates) {
  const ModelTerm& own = refined.candidate->term;
  std::vector<double> feeds;
  std::vector<std::size_t> cuts;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Setup& setup = observations[i]->profile->setup;
    if (!own.acts_on(*observations[i]->profile)) continue;
    const std::optional<double> feed = setup.feed_per_revolution();
    if (!feed) return false;
    cuts.push_back(i);
    if (gain_in(data, fitted, i) > gates.size * gates.size) feeds.push_back(*feed);
  }
  if (feeds.size() < 2 || std::ranges::max(feeds) < kOtherFeed * std::ranges::min(feeds))
    return false;
  const Eigen::Index a = refined.columns.cols();
  Eigen::MatrixXd apart = Eigen::MatrixXd::Zero(refined.columns.rows(), a * std::ssize(cuts));
  Eigen::Index column = 0;
  for (const std::size_t i : cuts) {
    const Eigen::Index first = data.first_row(i), count = data.count(i);
    apart.block(first, column, count, a) = refined.columns.middleRows(first, count);
    column += a;
  }
  const Projection each = project(data, apart);
  return each.gain - refined.projection.gain <
         penalty(data, each.rank - refined.projection.rank) + gates.tie_bic;
}

}  // namespace

std::optional<int> mark_at(const Profile& profile, double cycles, const Gates& gates,
                           double samples_a_value) {
  const Setup& setup = profile.setup;
  const auto samples = static_cast<double>(profile.positions.size());
  if (setup.kind != Kind::face || !setup.feed_mm_per_min || !setup.spindle_rpm || samples < 2.0)
    return std::nullopt;
  const double spacing = (setup.last_mm - setup.first_mm) / (samples - 1.0);
  const double marks =  // cycles a value
      samples_a_value * spacing * *setup.spindle_rpm / *setup.feed_mm_per_min;
  const double own = folded(samples_a_value * cycles / (samples - 1.0));
  for (int m = 1; m <= static_cast<int>(gates.feed_harmonics); ++m)
    if (std::abs(own - folded(m * marks)) * samples / samples_a_value <= gates.folded_widths)
      return m;
  return std::nullopt;
}

bool is_wave(const Model& model, const ModelTerm& term, std::span<const double> shape) {
  return std::ranges::any_of(fitted_observations(model), [&](const Observation* observation) {
    const Profile& profile = *observation->profile;
    return term.acts_on(profile) && term.effect->applies_to(profile.setup) &&
           !term.effect->lines(profile.stations(model.machine), shape).empty();
  });
}

std::string part_of_a_line(const Model& model, const Eigen::VectorXd& shapes,
                           const Refined& refined) {
  const ModelTerm& own = refined.candidate->term;
  const auto is_of = [&](const ModelTerm& term, double order) {
    bool shown = false;
    for (const Observation* observation : fitted_observations(model)) {
      const Profile& profile = *observation->profile;
      if (!own.acts_on(profile) || !term.acts_on(profile)) continue;  // a line of other profiles
      const Stations stations = profile.stations(model.machine);
      const auto lines = own.effect->lines(stations, refined.shape);
      if (lines.empty() || !lie_beside(lines, term.effect->lines(stations, shapes_of(term, shapes)),
                                       order, model.gates))
        return false;
      shown = true;
    }
    return shown && term.name != own.name;
  };
  for (const double order : {1.0, 2.0, 3.0, 1.0 / 2.0, 1.0 / 3.0})
    for (const ModelTerm& term : model.terms)
      if ((order == 1.0 || !term.effect->description().kinematic) && is_of(term, order))
        return (order == 1.0 ? "a modulation of " : "a harmonic of ") + term.name;
  return "";
}

bool is_of_feed_marks(const Model& model, const Whitened& data, const Refined& refined,
                      const Eigen::VectorXd& fitted, Folding folding) {
  const ModelTerm& own = refined.candidate->term;
  const std::vector<const Observation*> observations = fitted_observations(model);
  bool folded_in_one = false;
  double elsewhere = 0.0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Profile& profile = *observations[i]->profile;
    if (!own.acts_on(profile)) continue;
    const auto lines = own.effect->lines(profile.stations(model.machine), refined.shape);
    if (lines.empty()) return false;
    const double samples_a_value = folding == Folding::by_low_band
                                       ? std::ldexp(1.0, observations[i]->low_band.options().level)
                                       : 1.0;
    const double most = largest_mark_at(profile, *own.effect, lines, samples_a_value, model.gates);
    if (most > 0.0 && amplitude_on(model, refined, profile) <= most)
      folded_in_one = true;
    else
      elsewhere += gain_in(data, fitted, i);
  }
  return folded_in_one && elsewhere < model.gates.size * model.gates.size &&
         !is_one_wave(observations, data, refined, fitted, model.gates);
}

}  // namespace slideway
