#include "imagined.hpp"

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

}  // namespace

std::string lacks(const ModelTerm& term, const CutToCome& cut) {
  if (!term.acts_on(cut.profile)) return "";
  const std::vector<std::string> lacking = term.effect->lacking(cut.profile.setup);
  return lacking.empty() ? "" : "effect '" + term.name + "' needs " + joined(lacking);
}

Imagined imagine(const Problem& problem, const FittedModel& base, const CutToCome& cut) {
  for (const ModelTerm& term : base.model.terms)
    if (const std::string why = lacks(term, cut); !why.empty())
      throw UsageError("planned cut '" + cut.profile.name + "': " + why);
  const std::optional<std::size_t> which = like_which(base, cut);
  const Observation* const like = which ? base.fit.linear.observations[*which] : nullptr;
  Problem bare = problem;
  bare.effects.clear();
  bare.trace.own.clear();
  std::vector<Profile> one{cut.profile};
  if (like && !cut.profile.low_band) one[0].low_band = like->low_band.options();
  Imagined out{std::move(build_model(bare, one).observations[0]), {}};
  out.observation.profile = &cut.profile;
  leave_out(out.observation, values_at_axis(out.observation, base.model.machine));
  const std::optional<double>& declared = cut.profile.standard_uncertainty;
  if (like && (!declared || declared == like->profile->standard_uncertainty)) {
    out.noise = noise_like(base.fit.noise[*which], *like, out.observation);
    return out;
  }
  if (!declared)
    throw UsageError("planned cut '" + cut.profile.name +
                     "': no fitted profile of its kind and quantity tells its noise; accepted: "
                     "standard_uncertainty");
  out.noise = Noise::white(*declared, out.observation.values.size());
  out.noise.declared = true;
  return out;
}

}  // namespace slideway
