#include "outcome.hpp"

#include <algorithm>
#include <cmath>

#include "fit_numbers.hpp"
#include "form_text.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "structure.hpp"

namespace slideway {

std::vector<TriedEffect> tried(const SearchRound& round, const Gates& gates,
                               const TestedCandidate* except, std::optional<double> before_rms_um) {
  std::vector<TriedEffect> out;
  const double square = round.data.residual().squaredNorm();
  for (const TestedCandidate& each : round.tested) {
    if (&each == except) continue;
    const Refined& refined = each.refined;
    TriedEffect entry{refined.candidate->effect_name(), refined.candidate->term.profiles,
                      refined.delta_bic, each.p_value};
    if (std::string why = each.refused(gates); !why.empty()) entry.refused = std::move(why);
    if (before_rms_um)
      entry.rms_um =
          *before_rms_um * std::sqrt(std::max(0.0, 1.0 - refined.projection.gain / square));
    const std::vector<Parameter>& known = refined.candidate->term.effect->parameters();
    for (std::size_t p = 0; p < known.size(); ++p) {
      FittedParameter parameter;
      parameter.name = each.name() + "." + known[p].name;
      parameter.symbol = known[p].symbol;
      parameter.unit = known[p].unit;
      parameter.value = refined.values[static_cast<Eigen::Index>(p)];
      const double uncertainty = refined.uncertainties[static_cast<Eigen::Index>(p)];
      if (std::isfinite(uncertainty)) parameter.standard_uncertainty = uncertainty;
      entry.parameters.push_back(std::move(parameter));
    }
    out.push_back(std::move(entry));
  }
  return out;
}

AcceptedEffect as_accepted(const SearchRound& round, const TestedCandidate& choice,
                           const Gates& gates, std::optional<double> before_rms_um) {
  AcceptedEffect out{choice.refined.candidate, choice.refined.shape, {}};
  out.round.accepted = choice.refined.candidate->effect_name();
  out.round.profiles = choice.refined.candidate->term.profiles;
  out.round.delta_bic = choice.refined.delta_bic;
  out.round.p_value = choice.p_value;
  out.round.candidates = tried(round, gates, &choice, before_rms_um);
  if (choice.held_out) {
    out.round.before_holdout_rms_um = choice.held_out->before_um;
    out.round.after_holdout_rms_um = choice.held_out->after_um;
  }
  return out;
}

std::vector<std::string> outranked_by(const SearchRound& round, const TestedCandidate& chosen,
                                      const Gates& gates) {
  std::vector<std::string> out;
  const bool measured = is_measured(*chosen.refined.candidate);
  for (const TestedCandidate* each : round.outranked(chosen, gates))
    out.push_back((is_in_fewer_readings(*each, chosen)
                       ? std::string(measured ? "a measured cause is taken to act in all profiles"
                                              : "one instrument is taken to err alike in all that "
                                                "it reads") +
                             ", so " + chosen.name() + " stands, though " + each->name() +
                             " explains as much"
                       : chosen.name() + " was measured and " + each->name() +
                             " was not: it stands, though the other explains as much") +
                  "; difference in BIC " +
                  significant(each->refined.delta_bic - chosen.refined.delta_bic, 2));
  return out;
}

std::string form_of_another_cause(const TraceResult& out, const SquarenessCheck& check,
                                  const ModelResult& fit) {
  if (out.not_separable.empty()) return "";
  const bool too_large = check.verdict == Consistency::inconsistent &&
                         std::abs(*check.fit_rad) > std::abs(*check.indirect_rad);
  if (!too_large && fit.implausible.empty()) return "";
  std::vector<std::string> others;
  for (const auto& [effect, same] : out.not_separable) others.push_back(effect);
  return "the carriages cannot have made this form: " +
         (too_large ? check.reason : fit.implausible) + "; the same columns are made by " +
         joined(others) +
         ", and nothing here tells them apart: read the straightness along the slide "
         "(autocollimator), or cut and trace otherwise";
}

void doubt_what_some_have(const Disagreement& among, std::vector<AcceptedEffect>& effects) {
  for (AcceptedEffect& effect : effects) {
    const std::vector<std::string>& profiles = effect.round.profiles;
    std::vector<std::string>& rivals = effect.round.ambiguous_with;
    const bool is_odd = among.odd_one.empty() || std::ranges::count(profiles, among.odd_one) > 0;
    if (!profiles.empty() && is_odd && !is_kinematic(*effect.candidate) &&
        std::ranges::count(rivals, kUnnamedRival) == 0)
      rivals.emplace_back(kUnnamedRival);
  }
}

void doubt_what_is_uncertain(const FittedModel& fitted, const ModelResult& final,
                             TraceResult& out) {
  const Model& model = fitted.model;
  for (TraceRound& round : out.rounds) {
    const std::string name = term_name(round.accepted, round.profiles);
    const auto term = std::ranges::find(model.terms, name, &ModelTerm::name);
    if (!round.ambiguous_with.empty() || term == model.terms.end() || !term->effect->has_one_size())
      continue;
    const double size = widening_by_bend(fitted.fit, *term) * size_in_uncertainties(final, *term);
    if (!(size < model.gates.size)) continue;
    round.ambiguous_with.emplace_back(kUnnamedRival);
    if (out.verdict == TraceVerdict::explained) out.verdict = TraceVerdict::ambiguous;
    out.notes.push_back(name + ": its size is only " + significant(size, 2) +
                        " of its standard uncertainties, which hold what else may have made the "
                        "form");
  }
}

void say_unknown_causes(const Model& model, TraceResult& out) {
  for (const TraceRound& round : out.rounds) {
    const std::string name = term_name(round.accepted, round.profiles);
    const auto term = std::ranges::find(model.terms, name, &ModelTerm::name);
    if (term != model.terms.end() && term->effect->description().cause == kUnknownCause)
      out.notes.push_back(name + " describes what was left; its cause is not known");
  }
}

void say_why_refused(const std::string& otherwise, TraceResult& out) {
  for (TriedEffect& effect : out.refused) {
    if (effect.refused) continue;
    const auto left =
        std::ranges::find(out.left, term_name(effect.effect, effect.profiles), &LeftEffect::effect);
    effect.refused = left == out.left.end() ? otherwise : left->reason;
  }
}

void report_untestable(const Dictionary& dictionary, const Problem& problem, TraceResult& out) {
  for (const Untestable& effect : dictionary.not_testable) {
    out.not_testable.push_back({effect.effect, effect.needs});
    if (std::ranges::count(problem.own_effects, effect.effect, &DeclaredEffect::name) > 0)
      out.notes.push_back(effect.effect + " was not looked for: it needs " + effect.needs);
    if (std::ranges::count(effect_names(), effect.effect) == 0 ||
        effect.needs.find("feed") == std::string::npos)
      continue;
    const Description& what = specimen(effect.effect).description();
    for (TraceRound& round : out.rounds)
      if (what.kinematic && std::ranges::count(what.confounded_effects, round.accepted) > 0)
        round.ambiguous_with.push_back(effect.effect);
  }
}

void report_unnamed(const FittedModel& fitted, const Whitened& data, double p_value,
                    const std::vector<TestedCandidate>& tested, const TestedCandidate* wave,
                    ClosedLoop& closed) {
  const Structure structure = find_structure(fitted.model, data, fitted.fit.linear);
  std::optional<Unnamed>& unnamed = closed.trace.unnamed;
  Eigen::VectorXd folded;
  if (wave) folded = wave->refined.columns * wave->refined.projection.amplitudes;
  unnamed = describe(fitted, structure, data, folded);
  unnamed->p_value = p_value;
  closed.widening = widening(fitted.model, fitted.fit, structure, tested);
}

bool is_negative(const TraceResult& trace) {
  return trace.verdict == TraceVerdict::unnamed || trace.verdict == TraceVerdict::not_identifiable;
}

TraceVerdict verdict(const TraceResult& out, bool other_cause) {
  if (out.unnamed) return TraceVerdict::unnamed;
  if (other_cause) return TraceVerdict::not_identifiable;
  for (const TraceRound& round : out.rounds)
    if (!round.ambiguous_with.empty()) return TraceVerdict::ambiguous;
  return out.rounds.empty() ? TraceVerdict::nothing_missing : TraceVerdict::explained;
}

}  // namespace slideway
