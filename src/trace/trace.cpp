#include "slideway/trace/trace.hpp"

#include <algorithm>
#include <cmath>

#include "advice.hpp"
#include "background.hpp"
#include "detection.hpp"
#include "fit_numbers.hpp"
#include "round.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/crosscheck.hpp"
#include "structure.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostValues = 2048;  // of a profile, in a search
constexpr double kLeastJointSize = 3.0;    // of an effect in the joint fit, in
constexpr double kLeastSize = 5.0;         // standard uncertainties
constexpr double kSuperfluous = -10.0;     // ΔBIC an effect must keep up to stay

/// The problem with the low band in which effects are searched: the declared one, or the first
/// coarser one that leaves every profile few enough values.
Problem for_search(Problem problem, const std::vector<Profile>& profiles) {
  std::size_t most = 0;
  for (const Profile& profile : profiles) most = std::max(most, profile.positions.size());
  while ((most >> problem.low_band.level) > kMostValues) ++problem.low_band.level;
  return problem;
}

/// An effect that has been added to the declared model.
struct Added {
  const Candidate* candidate = nullptr;
  std::vector<double> shape;
  TraceRound round;
};

std::vector<Added> all_but(std::vector<Added> added, std::size_t i) {
  added.erase(std::next(added.begin(), static_cast<std::ptrdiff_t>(i)));
  return added;
}

class Loop {
 public:
  Loop(const Problem& problem, const std::vector<Profile>& profiles)
      : problem_(problem),
        profiles_(profiles),
        declared_(build_model(problem, profiles)),
        base_(build_model(for_search(problem, profiles), profiles)),
        first_fit_(fit(base_)),
        dictionary_(make_dictionary(base_, problem.trace.candidates,
                                    first_fit_.linear.prior_rows.rows())) {}

  TraceResult run() {
    State state = make_state({});
    before_ = summary_of(state);
    std::optional<Look> last;
    while (true) {
      last = look_at(state);
      if (static_cast<int>(state.added.size()) >= problem_.trace.max_effects) break;
      const std::optional<std::size_t> choice = last->choice();
      if (!choice || !try_adding(state, *last, *choice)) break;
      drop_superfluous(state);
    }
    const bool exchanged = exchange(state);
    if (drop_small(state, kLeastJointSize) || exchanged) last = look_at(state);
    const bool retracted = retract(state, last->data);
    if (retracted) last = look_at(state);
    return report(state, *last, retracted);
  }

 private:
  /// Its fit points into its model: moved, never copied.
  struct State {
    State(std::vector<Added> effects, Model with_effects, Fit of_it)
        : added(std::move(effects)), model(std::move(with_effects)), fit(std::move(of_it)) {}
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    State(State&&) = default;
    State& operator=(State&&) = default;

    std::vector<Added> added;
    Model model;
    Fit fit;
  };

  [[nodiscard]] Model with(const Model& base, const std::vector<Added>& added) const {
    Model model = base;
    for (const Added& effect : added)
      append_term(model, {effect.candidate->name(), effect.candidate->options, {}}, model.range);
    return model;
  }

  [[nodiscard]] Eigen::VectorXd shapes_of(const std::vector<Added>& added) const {
    std::vector<double> all(first_fit_.estimate.shapes.begin(), first_fit_.estimate.shapes.end());
    for (const Added& effect : added)
      all.insert(all.end(), effect.shape.begin(), effect.shape.end());
    return Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all));
  }

  [[nodiscard]] State make_state(std::vector<Added> added) const {
    State out{std::move(added), with(base_, {}), first_fit_};
    if (out.added.empty()) return out;
    out.model = with(base_, out.added);
    out.fit = fit(out.model, shapes_of(out.added));
    return out;
  }

  /// The report's numbers, at the declared level.
  [[nodiscard]] FitResult summary_of(const State& state) const {
    const auto level = [](const Model& model) {
      return model.observations.front().low_band.options().level;
    };
    if (level(base_) == level(declared_)) return summarise(state.model, state.fit);
    const Model model = with(declared_, state.added);
    return summarise(model, fit(model, shapes_of(state.added)));
  }

  [[nodiscard]] Candidates candidates_beside(const std::vector<Added>& added) const {
    Candidates out;
    for (const Candidate& candidate : dictionary_.candidates)
      if (std::none_of(added.begin(), added.end(),
                       [&](const Added& effect) { return effect.candidate == &candidate; }))
        out.push_back(&candidate);
    return out;
  }

  Look look_at(const State& state) {
    return look(state.model, state.fit, candidates_beside(state.added), problem_.trace.significance,
                calibration_);
  }

  bool try_adding(State& state, const Look& seen, std::size_t choice) {
    const Refined& refined = seen.refined[choice];
    Added next{refined.candidate, refined.shape, {}};
    next.round.accepted = refined.candidate->name();
    next.round.delta_bic = refined.delta_bic;
    next.round.p_value = seen.p_values[choice];
    next.round.candidates = tried(seen, choice);
    const FitResult before = summary_of(state);
    std::vector<Added> added = state.added;
    added.push_back(std::move(next));
    State extended = make_state(std::move(added));
    const FitResult after = summary_of(extended);
    TraceRound& round = extended.added.back().round;
    round.before_rms_um = before.rms_um.value_or(0.0);
    round.after_rms_um = after.rms_um.value_or(0.0);
    round.before_holdout_rms_um = holdout_rms_um(before);
    round.after_holdout_rms_um = holdout_rms_um(after);
    if (round.before_holdout_rms_um) {
      if (!(*round.after_holdout_rms_um < *round.before_holdout_rms_um)) {
        notes_.push_back(round.accepted + " was refused: it predicts the held-out profiles worse");
        return false;
      }
    } else if (seen.held_out[choice]) {
      round.before_holdout_rms_um = seen.held_out[choice]->before_um;
      round.after_holdout_rms_um = seen.held_out[choice]->after_um;
    }
    state = std::move(extended);
    return true;
  }

  [[nodiscard]] std::vector<TriedEffect> tried(const Look& seen,
                                               std::optional<std::size_t> without) const {
    std::vector<TriedEffect> out;
    const double square = seen.data.residual().squaredNorm();
    for (std::size_t i = 0; i < seen.refined.size(); ++i) {
      if (without && i == *without) continue;
      const Refined& refined = seen.refined[i];
      TriedEffect entry{refined.candidate->name(), refined.delta_bic, seen.p_values[i]};
      entry.refused = seen.refused[i];
      const double share = std::max(0.0, 1.0 - refined.projection.gain / square);
      entry.rms_um = before_->rms_um.value_or(0.0) * std::sqrt(share);
      const std::vector<Parameter>& known = refined.candidate->term.effect->parameters();
      for (std::size_t p = 0; p < known.size(); ++p) {
        FittedParameter parameter{entry.effect + "." + known[p].name, known[p].symbol,
                                  known[p].unit};
        parameter.value = refined.values[static_cast<Eigen::Index>(p)];
        parameter.standard_uncertainty = refined.uncertainties[static_cast<Eigen::Index>(p)];
        entry.parameters.push_back(std::move(parameter));
      }
      out.push_back(std::move(entry));
    }
    return out;
  }

  /// Earlier effects that the last one has made superfluous leave again.
  void drop_superfluous(State& state) {
    for (std::size_t i = 0; i + 1 < state.added.size();) {
      State without = make_state(all_but(state.added, i));
      const Added& effect = state.added[i];
      const Eigen::MatrixXd loose = loose_values(without.model, without.fit);
      const Whitened data(without.fit.linear,
                          background_noise(state.fit, loose_values(state.model, state.fit)), loose);
      const Projection own =
          project(data, stacked_columns(without.model, effect.candidate->term, effect.shape,
                                        data.rows() - data.values()));
      const double bic = static_cast<double>(effect.candidate->unknowns()) *
                             std::log(static_cast<double>(data.values())) -
                         own.gain;
      if (bic <= kSuperfluous) {
        ++i;
        continue;
      }
      notes_.push_back(effect.candidate->name() + " was dropped again: " +
                       state.added.back().candidate->name() + " has made it superfluous");
      state = std::move(without);
    }
  }

  /// Each effect once more against all others, the rest of the model as it now is: a better one
  /// takes its place, and those that are as good are its rivals. @return true if one did
  bool exchange(State& state) {
    bool changed = false;
    for (std::size_t i = 0; i < state.added.size(); ++i) {
      const State without = make_state(all_but(state.added, i));
      const Look seen = look_at(without);
      const std::optional<std::size_t> choice = seen.choice();
      if (!choice) continue;
      std::size_t own = *choice;
      const std::string& name = state.added[i].candidate->name();
      if (seen.refined[own].candidate->name() != name) {
        for (std::size_t j = 0; j < seen.refined.size(); ++j)
          if (seen.refined[j].candidate->name() == name && seen.refused[j].empty()) own = j;
        if (seen.refined[own].delta_bic > seen.refined[*choice].delta_bic ||
            seen.refined[own].candidate->name() != name) {
          notes_.push_back(name + " was exchanged for " + seen.refined[*choice].candidate->name() +
                           ", which fits better");
          own = *choice;
          state.added[i].candidate = seen.refined[own].candidate;
          state.added[i].shape = seen.refined[own].shape;
          state.added[i].round.accepted = seen.refined[own].candidate->name();
          state.added[i].round.delta_bic = seen.refined[own].delta_bic;
          state.added[i].round.p_value = seen.p_values[own];
          state.added[i].round.candidates = tried(seen, own);
          state = make_state(state.added);
          changed = true;
        }
      }
      TraceRound& round = state.added[i].round;
      round.ambiguous_with.clear();
      for (const std::size_t rival : seen.rivals(own)) {
        round.ambiguous_with.push_back(seen.refined[rival].candidate->name());
        advice_.push_back(separating_measurement(problem_, profiles_, without.model, without.fit,
                                                 seen.data, seen.refined[own],
                                                 seen.refined[rival]));
      }
    }
    return changed;
  }

  /// Whether an effect of one amplitude is below so many standard uncertainties in the joint fit.
  [[nodiscard]] bool is_small(const State& state, std::size_t i, double limit) const {
    const std::string& name = state.added[i].candidate->name();
    const std::vector<FittedParameter> own = parameters_of(summary_of(state), name);
    if (state.added[i].candidate->amplitudes() > 2 || own.empty() || !own[0].value ||
        !own[0].standard_uncertainty)
      return false;
    return std::abs(*own[0].value) < limit * *own[0].standard_uncertainty;
  }

  /// Effects that the joint fit does not bear out leave. @return true if one did
  bool drop_small(State& state, double limit) {
    bool changed = false;
    for (std::size_t i = state.added.size(); i-- > 0;) {
      if (!is_small(state, i, limit)) continue;
      notes_.push_back(state.added[i].candidate->name() +
                       " was taken back: in the joint fit it is below " + significant(limit, 1) +
                       " of its standard uncertainties");
      state = make_state(all_but(state.added, i));
      changed = true;
    }
    return changed;
  }

  /// Where structure is left, an effect stays only if it says more than an unnamed process alone
  /// would: the least bad name is not given. @return true if one had to go
  bool retract(State& state, const Whitened& data) {
    if (!lack_of_fit(data, state.fit.linear).significant()) return false;
    bool changed = drop_small(state, kLeastSize);
    for (std::size_t i = state.added.size(); i-- > 0;) {
      State without = make_state(all_but(state.added, i));
      const Whitened with_it(state.fit.linear, data.noise(), loose_values(state.model, state.fit));
      const Whitened without_it(without.fit.linear, data.noise(),
                                loose_values(without.model, without.fit));
      const double gain = (without_it.residual().squaredNorm() - with_it.residual().squaredNorm()) +
                          process_gain(state.model, with_it, state.fit.linear) -
                          process_gain(without.model, without_it, without.fit.linear);
      const double cost = static_cast<double>(state.added[i].candidate->unknowns()) *
                          std::log(static_cast<double>(data.values()));
      if (gain - cost >= -kSuperfluous) continue;
      notes_.push_back(state.added[i].candidate->name() +
                       " was taken back: a smooth process without a name fits as well");
      state = std::move(without);
      changed = true;
    }
    return drop_small(state, kLeastSize) || changed;
  }

  TraceResult report(const State& state, const Look& last, bool retracted) {
    TraceResult out;
    const FitResult after = summary_of(state);
    out.before = before_->parameters;
    out.after = after.parameters;
    out.before_rms_um = before_->rms_um;
    out.after_rms_um = after.rms_um;
    for (const Added& effect : state.added) {
      out.rounds.push_back(effect.round);
      out.rounds.back().parameters = parameters_of(after, effect.candidate->name());
    }
    const Candidates beside = candidates_beside(state.added);
    out.refused = tried(last, std::nullopt);
    for (TriedEffect& effect : out.refused)
      if (effect.refused.empty())
        effect.refused = retracted ? "a process without a name fits as well"
                         : static_cast<int>(state.added.size()) >= problem_.trace.max_effects
                             ? "max_effects effects are in the model"
                             : "the joint fit does not bear it out";
    const LackOfFit left = lack_of_fit(last.data, state.fit.linear);
    out.lack_of_fit_p = left.p_value;
    if (left.significant()) {
      out.unnamed = describe_structure(state.model, last.data, state.fit.linear);
      out.unnamed->p_value = left.p_value;
    }
    for (const Untestable& effect : dictionary_.not_testable)
      out.not_testable.emplace_back(effect.effect, effect.needs);
    out.not_separable = inseparable(state.model, state.fit, last.data, beside);
    if (calibration_)
      out.detection_limits = detection_limits(
          base_, Whitened(first_fit_.linear, last.data.noise(), loose_values(base_, first_fit_)),
          candidates_beside({}), *calibration_, problem_.trace.significance);
    out.advice = advice_;
    out.notes = notes_;
    const std::string other_cause = form_of_another_cause(out, state, after);
    if (!other_cause.empty()) out.advice.insert(out.advice.begin(), other_cause);
    out.verdict = verdict(out, !other_cause.empty());
    return out;
  }

  /// Form that the fit puts into the carriages although they can not have made it: the run-out or
  /// a good slide speak against it, and other effects make the same columns.
  [[nodiscard]] std::string form_of_another_cause(const TraceResult& out, const State& state,
                                                  const FitResult& fit) const {
    if (out.not_separable.empty()) return "";
    const SquarenessCheck check = check_squareness(state.model, problem_.runout, fit);
    const bool too_large =
        check.verdict == "inconsistent" && std::abs(*check.fit_rad) > std::abs(*check.indirect_rad);
    if (!too_large && fit.implausible.empty()) return "";
    std::vector<std::string> others;
    for (const auto& [effect, same] : out.not_separable) others.push_back(effect);
    return "the carriages can not have made this form: " +
           (too_large ? check.reason : fit.implausible) + "; the same columns are made by " +
           joined(others) +
           ", and nothing here tells them apart: read the straightness along the slide "
           "(autocollimator), or cut and trace otherwise";
  }

  static std::string verdict(const TraceResult& out, bool other_cause) {
    if (out.unnamed) return "unnamed";
    if (other_cause) return "not_identifiable";
    for (const TraceRound& round : out.rounds)
      if (!round.ambiguous_with.empty()) return "ambiguous";
    return out.rounds.empty() ? "nothing_missing" : "explained";
  }

  const Problem& problem_;
  const std::vector<Profile>& profiles_;
  Model declared_, base_;
  Fit first_fit_;
  Dictionary dictionary_;
  std::optional<Calibration> calibration_;
  std::optional<FitResult> before_;
  std::vector<std::string> advice_, notes_;
};

}  // namespace

TraceResult close_loop(const Problem& problem, const std::vector<Profile>& profiles) {
  return Loop(problem, profiles).run();
}

bool is_negative(const TraceResult& trace) {
  return trace.verdict == "unnamed" || trace.verdict == "not_identifiable";
}

}  // namespace slideway
