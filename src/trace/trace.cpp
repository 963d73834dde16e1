#include "slideway/trace/trace.hpp"

#include <algorithm>
#include <cmath>

#include "advice.hpp"
#include "blunder.hpp"
#include "blunder_rival.hpp"
#include "cross_validation.hpp"
#include "detection.hpp"
#include "disagreement.hpp"
#include "fine_line.hpp"
#include "fit_numbers.hpp"
#include "forms.hpp"
#include "instrument.hpp"
#include "known.hpp"
#include "loop.hpp"
#include "outcome.hpp"
#include "own_noise.hpp"
#include "rests_on.hpp"
#include "selection.hpp"
#include "sensitivity.hpp"
#include "set_gates.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/crosscheck.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/noise_model.hpp"
#include "time_blunder.hpp"
#include "widening.hpp"

namespace slideway {
namespace {

class Loop {
 public:
  /// @param declared  with what is shown
  Loop(const Problem& problem, const std::vector<Profile>& profiles, const FittedModel& declared,
       const std::vector<ShownEffect>& shown, TimeLimit& limit, const Progress& progress)
      : problem_(problem),
        progress_(progress),
        limit_(limit),
        shown_(shown),
        extender_(problem, profiles, declared, limit_, progress),
        statistics_(extender_) {}

  ClosedLoop run() {
    const Gates& gates = problem_.trace.gates;
    ClosedLoop closed;
    TraceResult& out = closed.trace;
    for (const Gate& gate : gate_table()) out.gates.emplace_back(gate.name, gates.*gate.value);
    Selection selection;
    if (limit_.allows([&] { selection = selected(out); }))
      report(selection, closed);
    else
      report_unfinished(closed);
    out.searches = extender_.searches();
    closed.searched = extender_.take_searched(selection.effects);
    return closed;
  }

 private:
  Selection selected(TraceResult& out) {
    const Gates& gates = problem_.trace.gates;
    std::vector<Blunder> blunders = find_blunders(extender_.base());
    if (!blunders.empty() && explained_by_an_effect(blunders, extender_)) blunders.clear();
    blunders = held_against_time(std::move(blunders), problem_, extender_, shown_);
    Selection selection = blunders.empty() ? select_effects(problem_, statistics_, gates, progress_)
                                           : nothing_selected(extender_, gates);
    judge(selection, blunders.empty());
    if (blunders.empty() && !limit_.allows([&] {
          if (profiles_differ())
            return void(blunders = find_time_blunders(problem_, extender_, shown_));
          auto found = time_blunders_in_place(selection.effects, problem_, extender_, shown_);
          blunders = std::move(found.better);
          add_as_rivals(found.as_good, selection);
        }))
      out.not_looked_at.emplace_back("another direction or start of one cut");
    if (!blunders.empty()) selection = nothing_selected(extender_, gates);
    if (profiles_differ()) doubt_what_some_have(among_, selection.effects);
    doubt_what_rests_on_others(extender_, selection);
    tell_rounds(selection.effects);
    out.blunders = std::move(blunders);
    return selection;
  }

  /// Whether the profiles disagree beside what was selected, and whether that and all else that is
  /// left is noise of their own.
  void judge(Selection& selection, bool may_be_noise) {
    const FittedModel& fitted = extender_.extended(selection.effects);
    const auto& [model, fit] = fitted;
    among_ = disagreement(fitted, noise_of_each(fit.linear, fit.noise, model.gates));
    if (!may_be_noise || !something_is_wrong(selection)) return;
    own_noise_ = noise_of_its_own(extender_, selection.effects);
    if (!own_noise_) return;
    among_ = {};
    selection.withheld = false;
    selection.lack_of_fit = lack_of_fit(fit.linear, *own_noise_, model.gates);
    selection.notes.emplace_back(
        "what is left is slow and every profile has its own: the noise holds it");
  }

  [[nodiscard]] bool profiles_differ() const {
    return among_.p_value < problem_.trace.gates.disagreement_p;
  }

  [[nodiscard]] bool something_is_wrong(const Selection& selection) const {
    return selection.withheld || selection.lack_of_fit.significant(problem_.trace.gates) ||
           profiles_differ();
  }

  void report(const Selection& selection, ClosedLoop& closed) {
    const Gates& gates = problem_.trace.gates;
    TraceResult& out = closed.trace;
    if (progress_) progress_("describing what is left", 0.0);
    report_effects(selection, out);
    report_rest(selection, closed);
    if (!limit_.allows([&] { report_limits(selection, out); }))
      out.not_looked_at.emplace_back("detection limits");
    out.instrument = shared_residuals(extender_.base());
    name_instrument(gates, out);
    const std::string other_cause =
        form_of_another_cause(out,
                              check_squareness(extender_.base().model, problem_.runout,
                                               extender_.summary(selection.effects)),
                              extender_.summary(selection.effects));
    out.advice.insert(out.advice.begin(), selection.advice.begin(), selection.advice.end());
    if (!other_cause.empty()) out.advice.insert(out.advice.begin(), other_cause);
    if (!out.blunders.empty()) out.advice.insert(out.advice.begin(), blunder_advice(out.blunders));
    out.verdict = verdict(out, !other_cause.empty());
    widen(selection, closed);
    if (other_cause.empty() && out.blunders.empty() && !own_noise_ &&
        out.rounds.size() == selection.effects.size() && !limit_.allows([&] {
          out.fragile = smallest_change(problem_, statistics_, selection, gates);
        }))
      out.not_looked_at.emplace_back("the smallest change of a gate that changes the verdict");
    if (!limit_.allows([&] {
          out.cross_validation = cross_validate(extender_.base().fit,
                                                extender_.extended(selection.effects).fit, gates);
        }))
      out.not_looked_at.emplace_back("prediction over gaps");
    if (!selection.effects.empty() && !out.cross_validation.empty())
      out.gain = gain_of(out.cross_validation);
    if (own_noise_)
      closed.extended = fit_as_complete(extender_.take_in_declared_band(selection.effects));
    else if (!selection.effects.empty())
      closed.extended = extender_.take_in_declared_band(selection.effects);
  }

  /// The declared model, and what it leaves: no name has been held against all its rivals.
  void report_unfinished(ClosedLoop& closed) {
    const Gates& gates = problem_.trace.gates;
    const FittedModel& base = extender_.base();
    TraceResult& out = closed.trace;
    out.unfinished = true;
    out.verdict = TraceVerdict::unnamed;
    const SearchRound* const first = extender_.searched({});
    const Whitened data = first ? first->data : Whitened(base.fit.linear, base.fit.noise);
    out.lack_of_fit_p = lack_of_fit(base.fit.linear, data.noise(), gates).p_value;
    if (first)
      report_refused(*first, "the time limit came before it was held against its rivals", out);
    report_unnamed(base, data, out.lack_of_fit_p,
                   first ? first->tested : std::vector<TestedCandidate>(), nullptr, closed);
  }

  /// @param otherwise  the reason of one that passes every gate of its own and was never accepted
  void report_refused(const SearchRound& round, const std::string& otherwise, TraceResult& out) {
    out.refused = tried(round, problem_.trace.gates, nullptr, extender_.summary({}).rms_um);
    say_why_refused(otherwise, out);
  }

  /// The residuals of the rounds as if the effects had been added one after the other.
  void tell_rounds(std::vector<AcceptedEffect>& effects) {
    std::vector<AcceptedEffect> so_far;
    for (AcceptedEffect& effect : effects) {
      const ModelResult& before = extender_.summary(so_far);
      so_far.push_back(effect);
      const ModelResult& after = extender_.summary(so_far);
      effect.round.before_rms_um = before.rms_um;
      effect.round.after_rms_um = after.rms_um;
      effect.round.before_rms_urad = before.rms_urad;
      effect.round.after_rms_urad = after.rms_urad;
      if (const auto held_out = holdout_rms_um(before)) {
        effect.round.before_holdout_rms_um = held_out;
        effect.round.after_holdout_rms_um = holdout_rms_um(after);
      }
    }
  }

  void report_effects(const Selection& selection, TraceResult& out) {
    out.notes = selection.notes;
    for (const auto& [effect, reason] : selection.left) out.left.push_back({effect, reason});
    for (std::size_t i = 0; i < selection.effects.size(); ++i) {
      const AcceptedEffect& effect = selection.effects[i];
      out.rounds.push_back(effect.round);
      if (effect.candidate->raises_degree)
        out.notes.push_back(effect.name() + ": raised to degree " +
                            std::to_string(*effect.candidate->options.degree));
      advise(selection, i, out);
    }
    if (!selection.instead.empty())
      out.advice.emplace_back(
          "read the straightness along the slide (autocollimator): it tells a way of a higher "
          "degree from other causes");
    if (const double radius = left_out_radius(extender_.extended(selection.effects).model);
        radius > left_out_radius(extender_.base().model))
      out.notes.push_back("values within r = " + significant(radius, 2) +
                          " mm are left out of the fit: a nose of " +
                          significant(problem_.trace.gates.nose_radius_mm, 2) +
                          " mm does not follow what is so steep at the centre");
  }

  /// The model without one accepted effect, and what could take its place.
  struct WithoutEffect {
    const FittedModel& fitted;
    const SearchRound& round;
    const TestedCandidate& own;
    std::vector<const TestedCandidate*> rivals;
  };

  WithoutEffect without_effect(const Selection& selection, std::size_t i) {
    const std::vector<AcceptedEffect> others = all_but(selection.effects, i);
    const SearchRound& round = extender_.search(others);
    const TestedCandidate& own = *find_tested(round, selection.effects[i], problem_.trace.gates);
    return {extender_.extended(others), round, own, round.rivals(own, problem_.trace.gates)};
  }

  /// Which measurement tells an effect from its rivals.
  void advise(const Selection& selection, std::size_t i, TraceResult& out) {
    const WithoutEffect place = without_effect(selection, i);
    for (const TestedCandidate* rival : place.rivals)
      out.advice.push_back(separating_measurement(
          problem_, extender_.profiles(), place.fitted.model, place.fitted.fit, place.round.data,
          place.own.refined, rival->refined));
  }

  void report_rest(const Selection& selection, ClosedLoop& closed) {
    TraceResult& out = closed.trace;
    const Gates& gates = problem_.trace.gates;
    const FittedModel& fitted = extender_.extended(selection.effects);
    const SearchRound& last = extender_.search(selection.effects);
    report_refused(last,
                   distinct_effects(selection.effects) >= problem_.trace.max_effects
                       ? "max_effects effects are in the model"
                       : "beside the others it does not help",
                   out);
    out.lack_of_fit_p = selection.lack_of_fit.p_value;
    double found_p = std::min(selection.lack_of_fit.p_value, among_.p_value);
    bool is_wrong = !out.blunders.empty() || something_is_wrong(selection);
    const std::vector<PureErrorCheck> repeats = check_repeats(fitted.fit.linear, gates);
    for (const PureErrorCheck& each : repeats) {
      if (each.verdict != RepeatFit::lack_of_fit) continue;
      found_p = std::min(found_p, each.p_value);
      is_wrong = true;
    }
    if (!is_wrong && !own_noise_ && repeats.empty()) {  // what repeats share is texture as well
      const double evidence = shared_evidence(fitted);
      found_p = std::min(found_p, std::exp(-evidence));
      is_wrong = evidence > gates.shared_evidence;
    }
    if (const auto line = fine_line(fitted.fit.linear, last.data.noise(), gates)) {
      found_p = std::min(found_p, line->p_value);
      is_wrong = true;
      out.advice.push_back(fine_line_advice(*line));
    }
    const TestedCandidate* const wave = folded_wave(last, gates);
    if (wave) {
      found_p = std::min(found_p, std::exp(0.5 * wave->delta_bic_beside()));
      is_wrong = true;
      out.advice.push_back(finer_band_advice(fitted.fit.linear, *wave, extender_.is_coarser()));
    }
    if (!is_wrong) return;
    report_unnamed(fitted, last.data, found_p, last.tested, wave, closed);
    if (profiles_differ() && out.blunders.empty())
      out.advice.push_back(disagreement_advice(among_));
    if (!limit_.allows([&] {
          out.unnamed->forms = describe_in_forms(extender_, selection.effects, *out.unnamed);
        }))
      out.not_looked_at.emplace_back("short formulas of what is left");
    if (!out.unnamed->forms.empty()) out.unnamed->to_confirm = what_separates(*out.unnamed);
  }

  /// By what a process without a name would do in the place of effects that are not sure, and
  /// their rivals. Where the carriages cannot have made what they were raised to, they may as well
  /// be as declared.
  void widen(const Selection& selection, ClosedLoop& closed) {
    const FittedModel& fitted = extender_.extended(selection.effects);
    std::vector<std::size_t> unsure = selection.unsure;
    const bool of_another_cause = closed.trace.verdict == TraceVerdict::not_identifiable;
    for (std::size_t i = 0; i < selection.effects.size(); ++i)
      if (of_another_cause && std::ranges::count(unsure, i) == 0 &&
          selection.effects[i].candidate->term.effect->is_carriage())
        unsure.push_back(i);
    if (!closed.trace.unnamed && !unsure.empty()) {
      const FittedModel& without = extender_.extended(all_but(selection.effects, unsure));
      closed.widening = widening_instead(selection, fitted, without);
      if (of_another_cause) closed.widening->add_absence(fitted, without);
    }
    const auto widened = [&]() -> Widening& {
      if (!closed.widening) closed.widening.emplace(fitted.fit.linear.prior_rows.cols());
      return *closed.widening;
    };
    for (const std::vector<AcceptedEffect>& each : selection.instead)
      widened().add_absence(fitted, extender_.extended(each));
    for (const auto& each : selection.otherwise) widened().add_absence(fitted, *each);
    for (std::size_t i = 0; i < selection.effects.size(); ++i) {
      const WithoutEffect place = without_effect(selection, i);
      for (const auto& rivals : {place.rivals, place.round.in_more_readings(place.own)})
        if (!rivals.empty()) widened().add_rivals(fitted, place.fitted, rivals);
    }
  }

  Widening widening_instead(const Selection& selection, const FittedModel& fitted,
                            const FittedModel& without) {
    const SearchRound& last = extender_.search(selection.effects);
    const Whitened data(without.fit.linear, last.data.noise(), last.data.undescribed());
    return widening(fitted.model, fitted.fit,
                    find_structure(without.model, data, without.fit.linear), last.tested);
  }

  void report_limits(const Selection& selection, TraceResult& out) {
    report_untestable(extender_.dictionary(), problem_, out);
    const FittedModel& fitted = extender_.extended(selection.effects);
    const Whitened& data = extender_.search(selection.effects).data;
    out.not_separable =
        inseparable(fitted.model, fitted.fit, data, extender_.candidates_beside(selection.effects));
    if (!extender_.calibration()) return;
    const FittedModel& base = extender_.extended(raised_degrees(selection.effects));
    Candidates everywhere;
    for (const Candidate& each : extender_.dictionary().candidates)
      if (each.stands_for_effect()) everywhere.push_back(&each);
    const std::vector<Noise>&searched = own_noise_ ? *own_noise_ : data.noise(),
          &of_fit = own_noise_ ? *own_noise_ : fitted.fit.noise;
    out.detection_limits = detection_limits(base, {base.fit.linear, searched}, of_fit, everywhere,
                                            *extender_.calibration());
  }

  const Problem& problem_;
  const Progress& progress_;
  TimeLimit& limit_;
  const std::vector<ShownEffect>& shown_;
  ModelExtender extender_;
  SetStatistics statistics_;
  Disagreement among_;                           // of the profiles, beside what was selected
  std::optional<std::vector<Noise>> own_noise_;  // that holds all that is left
};

}  // namespace

ClosedLoop close_loop(const Problem& problem, const std::vector<Profile>& profiles,
                      const FittedModel& declared, TimeLimit& limit, const Progress& progress) {
  Known known = known_before_search(shown_by_samples(problem, declared), declared);
  const auto run = [&] {
    const FittedModel& begun = known.fitted ? *known.fitted : declared;
    return Loop(problem, profiles, begun, known.shown, limit, progress).run();
  };
  ClosedLoop out = run();
  auto present = without_absent(known.shown, out.extended   ? *out.extended
                                             : known.fitted ? *known.fitted
                                                            : declared);
  if (present.size() < known.shown.size()) {
    known = known_before_search(std::move(present), declared);
    out = run();
  }
  TraceResult& trace = out.trace;
  trace.notes.insert(trace.notes.begin(), known.notes.begin(), known.notes.end());
  if (!known.rounds.empty() && trace.verdict == TraceVerdict::nothing_missing)
    trace.verdict = TraceVerdict::explained;
  trace.rounds.insert(trace.rounds.begin(), known.rounds.begin(), known.rounds.end());
  if ((!known.notes.empty() || !known.rounds.empty()) && !out.extended)
    out.extended = std::move(known.fitted);
  if (out.extended) allow_for_others(problem, *out.extended);
  return out;
}

}  // namespace slideway
