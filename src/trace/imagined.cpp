#include "imagined.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/left_out.hpp"

namespace slideway {
namespace {

/// Noise of a trace to come: that of the profile it is like, for as many values as it has.
Noise noise_like(const Noise& known, const Observation& like, const Observation& observation) {
  const auto n = observation.values.size();
  if (n == like.values.size()) return known;
  Noise out(known.covariance(), n);
  out.declared = known.declared;
  out.overruled = known.overruled;
  out.pool = known.pool;
  out.freedom = known.freedom * static_cast<double>(n) / static_cast<double>(like.values.size());
  out.alternatives = known.alternatives;
  return out;
}

/// The fitted observation a cut takes its low band and its noise from, or nothing: the one it is
/// like, else the first of its kind and quantity.
std::optional<std::size_t> like_which(const FittedModel& base, const CutToCome& cut) {
  const auto& observations = base.fit.linear.observations;
  const Setup& setup = cut.profile.setup;
  std::optional<std::size_t> out;
  for (std::size_t i = observations.size(); i-- > 0;) {
    const Profile& profile = *observations[i]->profile;
    if (profile.name == cut.like) return i;
    if (profile.setup.kind == setup.kind && profile.setup.quantity == setup.quantity) out = i;
  }
  return out;
}

/// A cut with its low band, and how much of the variance of its noise is like that of the profile
/// it is like: means have less of it.
struct Seen {
  Profile profile;
  double variance = 1.0;
};

int level_of_means(const LowBandOptions& samples, const Profile& means) {
  return samples.level - means.low_band->level;
}

/// In the low band of a search as the profiles there: two laws of one form there would else differ
/// by what varies within a mean.
Seen seen_in(const SearchBand& band, const Problem& problem, LowBandOptions options,
             const Observation* like, const CutToCome& cut) {
  int level = 0;
  for (std::size_t i = 0; like && i < band.profiles.size(); ++i)
    if (band.profiles[i].name == like->profile->name) {
      level = level_of_means(band.low_bands[i], band.profiles[i]);
      if (!cut.profile.low_band) options = band.low_bands[i];
    }
  options = with_at_most(std::move(options), cut.profile.positions.size(),
                         static_cast<std::size_t>(problem.trace.gates.search_values));
  Seen out{in_means(cut.profile, options)};
  out.variance = std::ldexp(1.0, level - level_of_means(options, out.profile));
  return out;
}

Seen seen(const SearchBand* band, const Problem& problem, const Observation* like,
          const CutToCome& cut) {
  LowBandOptions options = cut.profile.low_band ? *cut.profile.low_band
                           : like               ? like->low_band.options()
                                                : problem.low_band;
  if (band) return seen_in(*band, problem, std::move(options), like, cut);
  Seen out{cut.profile};
  out.profile.low_band = std::move(options);
  return out;
}

bool is_declared(const Problem& problem, const ModelTerm& term) {
  return std::ranges::any_of(problem.effects, [&](const DeclaredEffect& each) {
    return term_name(each.name, each.options.profiles) == term.name;
  });
}

/// An effect that was declared for each profile alone has a size of its own in the cut, too.
void free_what_each_has(const Problem& problem, const FittedModel& base, const Observation& like,
                        Observation& observation) {
  for (ModelTerm term : base.model.terms) {
    if (term.profiles != std::vector{like.profile->name} || !is_declared(problem, term)) continue;
    term.profiles.clear();
    const Eigen::MatrixXd columns =
        low_band_columns(base.model, term, observation, shapes_of(term, base.fit.estimate.shapes));
    Eigen::MatrixXd all(columns.rows(), observation.nuisances.cols() + columns.cols());
    all << observation.nuisances, columns;
    observation.nuisances = std::move(all);
    observation.nuisance_names.resize(observation.nuisances.cols(), term.name);
  }
}

/// What an effect lacks on a cut to come: "effect 'linear_drift' needs feed_mm_per_min", or "".
std::string lacks(const ModelTerm& term, const CutToCome& cut) {
  if (!term.acts_on(cut.profile)) return "";
  const std::vector<std::string> lacking = term.effect->lacking(cut.profile.setup);
  return lacking.empty() ? "" : "effect '" + term.name + "' needs " + joined(lacking);
}

}  // namespace

std::vector<CutToCome> with_found_effects(const Problem& problem, const Model& model,
                                          std::vector<CutToCome> cuts,
                                          std::vector<std::string>& left_out) {
  std::erase_if(cuts, [&](const CutToCome& cut) {
    for (const ModelTerm& term : model.terms) {
      if (is_declared(problem, term)) continue;
      const std::string why = lacks(term, cut);
      if (why.empty()) continue;
      left_out.push_back("planned cut '" + cut.profile.name + "': " + why);
      return true;
    }
    return false;
  });
  return cuts;
}

Imagined imagine(const Problem& problem, const FittedModel& base, const SearchBand* band,
                 const CutToCome& cut) {
  for (const ModelTerm& term : base.model.terms)
    if (const std::string why = lacks(term, cut); !why.empty())
      throw UsageError("planned cut '" + cut.profile.name + "': " + why);
  const std::optional<std::size_t> which = like_which(base, cut);
  const Observation* const like = which ? base.fit.linear.observations[*which] : nullptr;
  Problem bare = problem;
  bare.effects.clear();
  bare.trace.own.clear();
  auto [profile, variance] = seen(band, problem, like, cut);
  std::vector<Profile> one{std::move(profile)};
  Observation observation = std::move(build_model(bare, one).observations[0]);
  Imagined out{std::make_shared<const Profile>(std::move(one[0])), std::move(observation), {}};
  out.observation.profile = out.profile.get();
  if (like) free_what_each_has(problem, base, *like, out.observation);
  leave_out(out.observation, values_at_axis(out.observation, base.model.machine));
  const std::optional<double>& declared = cut.profile.standard_uncertainty;
  if (like && (!declared || declared == like->profile->standard_uncertainty)) {
    out.noise = noise_like(base.fit.noise[*which], *like, out.observation);
    if (variance != 1.0) out.noise = out.noise.scaled(variance);
    return out;
  }
  if (!declared)
    throw UsageError("planned cut '" + cut.profile.name +
                     "': no fitted profile of its kind and quantity tells its noise; accepted: "
                     "standard_uncertainty");
  out.noise = Noise::white(*out.profile->standard_uncertainty, out.observation.values.size());
  out.noise.declared = true;
  return out;
}

}  // namespace slideway
