#include "slideway/trace/trace.hpp"

#include <algorithm>
#include <cmath>

#include "advice.hpp"
#include "background.hpp"
#include "detection.hpp"
#include "fit_numbers.hpp"
#include "gates.hpp"
#include "loop.hpp"
#include "outcome.hpp"
#include "slideway/base/text.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/crosscheck.hpp"
#include "structure.hpp"
#include "widening.hpp"

namespace slideway {
namespace {

constexpr double kBetter = 2.0;  // of BIC, for one effect to take another's place

class Loop {
 public:
  Loop(const Problem& problem, const std::vector<Profile>& profiles, const FittedModel& declared,
       const Progress& progress)
      : problem_(problem),
        profiles_(profiles),
        progress_(progress),
        extender_(problem, profiles, declared) {
    tell("making the columns of every candidate");
    dictionary_ = make_dictionary(extender_.base().model, problem,
                                  extender_.base().fit.linear.prior_rows.rows());
  }

  ClosedLoop run() {
    Extended state = extender_.extend({});
    before_ = extender_.summary(state);
    std::optional<Look> last;
    bool dropped = false;
    while (true) {
      tell_round(state);
      last = look_at(state);
      if (!first_look_) first_look_ = last;
      if (is_full(state)) break;
      const Seen* choice = last->choice();
      if (!choice) break;
      if (try_adding(state, *last, *choice)) {
        dropped = drop_superfluous(state) || dropped;
      } else {
        ruled_out_.push_back(choice->name());
      }
    }
    const bool exchanged = exchange(state);
    const bool changed = drop_small(state, kLeastJointSize) || exchanged;
    if (changed) last = look_at(state);
    const bool retracted = retract(state, last->data);
    if (retracted) last = look_at(state);
    if (dropped || changed || retracted) retell(state);
    tell("describing what is left");
    ClosedLoop out = report(state, *last, retracted);
    if (!state.added.empty()) out.extended = extender_.in_declared_band(std::move(state));
    return out;
  }

 private:
  void tell(const std::string& stage, double done = 0.0) const {
    if (progress_) progress_(stage, done);
  }

  [[nodiscard]] bool is_full(const Extended& state) const {
    return std::ssize(state.added) >= problem_.trace.max_effects;
  }

  /// Names that stand in the model already, or that have been ruled out.
  [[nodiscard]] std::vector<std::string> taken(const std::vector<Added>& added) const {
    std::vector<std::string> out = ruled_out_;
    for (const Added& effect : added) out.push_back(effect.name());
    return out;
  }

  [[nodiscard]] Candidates candidates_without(const std::vector<std::string>& names) const {
    Candidates out;
    for (const Candidate& candidate : dictionary_.candidates)
      if (std::find(names.begin(), names.end(), candidate.name()) == names.end())
        out.push_back(&candidate);
    return out;
  }

  void tell_round(const Extended& state) const {
    tell("searching round " + std::to_string(state.added.size() + 1));
  }

  Look look_at(const Extended& state) {
    return look(state.model, state.fit, candidates_without(taken(state.added)),
                problem_.trace.significance, calibration_, [&](double done) {
                  if (done < 1.0) return tell("bootstrap", done);
                  tell_round(state);
                });
  }

  /// The data made white for a model, with the noise of another look at them.
  static Whitened whitened(const Extended& state, std::vector<Noise> noise) {
    const Eigen::MatrixXd loose = loose_values(state.model, state.fit, noise);
    return {state.fit.linear, std::move(noise), loose};
  }

  /// Takes a choice over into what is known of an added effect.
  void record(const Look& look, const Seen& choice, Added& added) const {
    added.candidate = choice.refined.candidate;
    added.shape = choice.refined.shape;
    added.round.accepted = choice.name();
    added.round.delta_bic = choice.refined.delta_bic;
    added.round.p_value = choice.p_value;
    added.round.candidates = tried(look, &choice, before_->rms_um);
    added.round.ambiguous_with.clear();
    for (const Seen* rival : look.rivals(choice))
      added.round.ambiguous_with.push_back(rival->name());
    if (!choice.held_out) return;
    added.round.before_holdout_rms_um = choice.held_out->before_um;
    added.round.after_holdout_rms_um = choice.held_out->after_um;
  }

  /// Profiles held out by the problem stand before those left out in turn.
  static void set_residuals(const ModelResult& before, const ModelResult& after,
                            TraceRound& round) {
    round.before_rms_um = before.rms_um;
    round.after_rms_um = after.rms_um;
    round.before_rms_urad = before.rms_urad;
    round.after_rms_urad = after.rms_urad;
    if (const auto held_out = holdout_rms_um(before)) {
      round.before_holdout_rms_um = held_out;
      round.after_holdout_rms_um = holdout_rms_um(after);
    }
  }

  /// The rounds as if what is in the model at the end had been added one after the other: effects
  /// have been exchanged, and have left.
  void retell(Extended& state) const {
    ModelResult before = *before_;
    const auto first = state.added.begin(), end = state.added.end();
    for (auto effect = first; effect != end; ++effect) {
      const auto next = std::next(effect);
      ModelResult after = next == end ? extender_.summary(state)
                                      : extender_.summary(extender_.extend({first, next}));
      set_residuals(before, after, effect->round);
      before = std::move(after);
    }
  }

  bool try_adding(Extended& state, const Look& look, const Seen& choice) {
    const ModelResult& before = extender_.summary(state);
    std::vector<Added> added = state.added;
    record(look, choice, added.emplace_back());
    Extended extended = extender_.extend(std::move(added));
    const ModelResult& after = extender_.summary(extended);
    set_residuals(before, after, extended.added.back().round);
    if (const auto held_out = holdout_rms_um(before);
        held_out && !(*holdout_rms_um(after) < *held_out)) {
      notes_.push_back(choice.name() + " was refused: it predicts the held-out profiles worse");
      return false;
    }
    if (is_carriage_effect(choice.name()) &&
        !outdoes_process(extended, state, look.data.noise(), state.added.size())) {
      notes_.push_back(choice.name() +
                       " was refused: a smooth process without a name fits as well");
      return false;
    }
    state = std::move(extended);
    return true;
  }

  /// Whether an effect of a model says more than a process without a name would in its place
  /// (a polynomial comes near everything smooth).
  static bool outdoes_process(const Extended& with, const Extended& without,
                              const std::vector<Noise>& noise, std::size_t which) {
    const Whitened with_it = whitened(with, noise), without_it = whitened(without, noise);
    const double gain = (without_it.residual().squaredNorm() - with_it.residual().squaredNorm()) +
                        find_structure(with.model, with_it, with.fit.linear).gain() -
                        find_structure(without.model, without_it, without.fit.linear).gain();
    const Candidate& candidate = *with.added[which].candidate;
    return gain - penalty(with_it, candidate.unknowns(candidate.amplitudes())) >= kEnough;
  }

  /// Earlier effects that the last one has made superfluous leave again. @return true if one did
  bool drop_superfluous(Extended& state) {
    bool changed = false;
    for (std::size_t i = 0; i + 1 < state.added.size();) {
      Extended without = extender_.extend(all_but(state.added, i));
      const Added& effect = state.added[i];
      const Whitened data = whitened(
          without,
          background_noise(state.fit, loose_values(state.model, state.fit, state.fit.noise)));
      const Projection own =
          project(data, stacked_columns(without.model, effect.candidate->term, effect.shape,
                                        data.rows() - data.values()));
      if (own.gain - penalty(data, effect.candidate->unknowns(own.rank)) >= kEnough) {
        ++i;
        continue;
      }
      notes_.push_back(effect.name() + " was dropped again: " + state.added.back().name() +
                       " has made it superfluous");
      state = std::move(without);
      changed = true;
    }
    return changed;
  }

  /// Each effect once more against all others, the rest of the model as it now is: a better one
  /// takes its place, and those that are as good are its rivals. @return true if one did
  bool exchange(Extended& state) {
    bool changed = false;
    for (std::size_t i = 0; i < state.added.size(); ++i) {
      tell("comparing rivals", static_cast<double>(i) / static_cast<double>(state.added.size()));
      const Extended without = extender_.extend(all_but(state.added, i));
      // The others' names are no choice, but rivals they can be: two lines of one clock.
      const bool as_first = without.added.empty() && ruled_out_.empty();
      const Look look =
          as_first ? *first_look_
                   : slideway::look(without.model, without.fit, candidates_without(ruled_out_),
                                    problem_.trace.significance, calibration_);
      const Seen* best = look.choice(taken(without.added));
      if (!best) continue;
      const Seen* own = nullptr;
      for (const Seen& each : look.seen)
        if (!own && each.name() == state.added[i].name() && each.refused.empty()) own = &each;
      if (!own || own->refined.delta_bic > best->refined.delta_bic + kBetter) own = best;
      if (own->refined.candidate != state.added[i].candidate) {
        if (own->name() != state.added[i].name())
          notes_.push_back(state.added[i].name() + " was exchanged for " + own->name() +
                           ", which fits better");
        record(look, *own, state.added[i]);
        state = extender_.extend(std::move(state.added));
        changed = true;
      }
      std::vector<std::string>& rivals = state.added[i].round.ambiguous_with;
      rivals.clear();
      for (const Seen* rival : look.rivals(*own)) {
        rivals.push_back(rival->name());
        advice_.push_back(separating_measurement(problem_, profiles_, without.model, without.fit,
                                                 look.data, own->refined, rival->refined));
      }
    }
    return changed;
  }

  /// Effects of one size that the joint fit has below so many standard uncertainties leave.
  /// @return true if one did
  bool drop_small(Extended& state, double limit) {
    bool changed = false;
    for (std::size_t i = state.added.size(); i-- > 0;) {
      const Added& effect = state.added[i];
      const std::vector<FittedParameter> own =
          parameters_of(extender_.summary(state), effect.name());
      if (!effect.candidate->term.effect->has_one_size() || effect.candidate->raises_degree ||
          own.empty() || !own[0].value || !own[0].standard_uncertainty ||
          std::abs(*own[0].value) >= limit * *own[0].standard_uncertainty)
        continue;
      notes_.push_back(effect.name() + " was taken back: in the joint fit it is below " +
                       significant(limit, 1) + " of its standard uncertainties");
      state = extender_.extend(all_but(state.added, i));
      changed = true;
    }
    return changed;
  }

  /// Where structure is left, an effect stays only if it says more than an unnamed process alone
  /// would: the least bad name is not given. @return true if one had to go
  bool retract(Extended& state, const Whitened& data) {
    if (!lack_of_fit(data, state.fit.linear).significant()) return false;
    bool changed = drop_small(state, kLeastSize);
    for (std::size_t i = state.added.size(); i-- > 0;) {
      Extended without = extender_.extend(all_but(state.added, i));
      if (outdoes_process(state, without, data.noise(), i)) continue;
      notes_.push_back(state.added[i].name() +
                       " was taken back: a smooth process without a name fits as well");
      state = std::move(without);
      changed = true;
    }
    return drop_small(state, kLeastSize) || changed;
  }

  /// All but the extended model.
  ClosedLoop report(const Extended& state, const Look& last, bool retracted) {
    ClosedLoop closed;
    TraceResult& out = closed.trace;
    const ModelResult& after = extender_.summary(state);
    for (const Added& effect : state.added) {
      out.rounds.push_back(effect.round);
      out.rounds.back().parameters = parameters_of(after, effect.name());
      if (effect.candidate->raises_degree)
        notes_.push_back("straightness: raised to degree " +
                         std::to_string(*effect.candidate->options.degree));
    }
    if (state.lost_centre_mm > 0.0)
      notes_.push_back("values within r = " + significant(state.lost_centre_mm, 2) +
                       " mm are left out of the fit: what is so steep at the centre, a tool's nose "
                       "(2 mm assumed) does not follow");
    out.refused = tried(last, nullptr, before_->rms_um);
    for (TriedEffect& effect : out.refused)
      if (!effect.refused)
        effect.refused = retracted        ? "a process without a name fits as well"
                         : is_full(state) ? "max_effects effects are in the model"
                                          : "the joint fit does not bear it out";
    const LackOfFit left = lack_of_fit(last.data, state.fit.linear);
    out.lack_of_fit_p = left.p_value;
    if (left.significant()) {
      const Structure structure = find_structure(state.model, last.data, state.fit.linear);
      out.unnamed = describe(structure, last.data, state.fit.linear);
      out.unnamed->p_value = left.p_value;
      closed.widening = widening(state.fit, structure, last);
    }
    for (const Untestable& effect : dictionary_.not_testable)
      out.not_testable.push_back({effect.effect, effect.needs});
    out.not_separable =
        inseparable(state.model, state.fit, last.data, candidates_without(taken(state.added)));
    if (calibration_)
      out.detection_limits = detection_limits(
          extender_.base(),
          {extender_.base().fit.linear, last.data.noise(),
           loose_values(extender_.base().model, extender_.base().fit, last.data.noise())},
          state.fit.noise, candidates_without({}), *calibration_, problem_.trace.significance);
    out.advice = advice_;
    out.notes = notes_;
    const std::string other_cause =
        form_of_another_cause(out, check_squareness(state.model, problem_.runout, after), after);
    if (!other_cause.empty()) out.advice.insert(out.advice.begin(), other_cause);
    out.verdict = verdict(out, !other_cause.empty());
    return closed;
  }

  const Problem& problem_;
  const std::vector<Profile>& profiles_;
  const Progress& progress_;
  Extender extender_;
  Dictionary dictionary_;
  std::optional<Calibration> calibration_;
  std::optional<Look> first_look_;  // at the declared model alone
  std::optional<ModelResult> before_;
  std::vector<std::string> ruled_out_, advice_, notes_;
};

}  // namespace

TraceResult close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                       const Progress& progress) {
  return close_loop(problem, profiles, fit_declared(problem, profiles), progress).trace;
}

ClosedLoop close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                      const FittedModel& declared, const Progress& progress) {
  return Loop(problem, profiles, declared, progress).run();
}

bool is_negative(const TraceResult& trace) {
  return trace.verdict == TraceVerdict::unnamed || trace.verdict == TraceVerdict::not_identifiable;
}

}  // namespace slideway
