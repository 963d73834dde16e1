#include "summary.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

constexpr std::size_t kFewLetters = 38;               // names that leave room for a sentence
constexpr std::size_t kShortNames = 30;               // and for its end
constexpr std::size_t kTwoLines = 2 * kBoxText - 20;  // with the badge, and words that do not break

std::string in_expanded_uncertainties(double shift) {
  return number(std::round(100.0 * std::abs(shift)) / 100.0, 2) + " times its U";
}

/// Accepted effects: one of the same rivals that came in for one cut after the other is one, of all
/// these cuts.
std::vector<TraceRound> found_effects(const TraceResult& trace) {
  std::vector<TraceRound> out;
  for (const TraceRound& round : trace.rounds) {
    const auto same = std::ranges::find_if(out, [&](const TraceRound& other) {
      return other.accepted == round.accepted && other.ambiguous_with == round.ambiguous_with &&
             !other.profiles.empty() && !round.profiles.empty();
    });
    if (same == out.end()) {
      TraceRound& effect = out.emplace_back();
      effect.accepted = round.accepted;
      effect.profiles = round.profiles;
      effect.ambiguous_with = round.ambiguous_with;
    } else {
      same->profiles.insert(same->profiles.end(), round.profiles.begin(), round.profiles.end());
    }
  }
  return out;
}

/// What was raised to a higher degree was in the model before.
std::string title_in(const Analysis& analysis, const std::string& name) {
  const auto& declared = analysis.result.declared;
  const bool is_raised = declared && std::ranges::count(declared->effects, name) > 0;
  return (is_raised ? "a higher degree of " : "") + effect_title(name);
}

/// "(a or b) and c"
std::string found(const Analysis& analysis) {
  const std::vector<TraceRound> effects = found_effects(*analysis.trace);
  std::vector<std::string> out;
  for (const TraceRound& effect : effects) {
    std::vector<std::string> titles;
    for (const std::string& name : names_of(effect)) titles.push_back(title_in(analysis, name));
    const std::string names = joined(titles, " or ");
    const bool is_choice = effects.size() > 1 && !effect.ambiguous_with.empty();
    out.push_back(is_choice ? "(" + names + ")" : names);
  }
  return joined(out, " and ");
}

/// The same in so many letters, if it can be: rivals are counted, then the last effects.
std::string found_in_brief(const Analysis& analysis, std::size_t letters) {
  const std::vector<TraceRound> effects = found_effects(*analysis.trace);
  const std::size_t count = effects.size();
  const auto first = [&](std::size_t named) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < named; ++i) {
      const TraceRound& round = effects[i];
      const std::size_t rivals = round.ambiguous_with.size();
      names.push_back(title_in(analysis, round.accepted) +
                      (rivals > 0 ? " (" + counted(rivals, "rival") + ")" : std::string()));
    }
    if (named < count) names.push_back(std::to_string(count - named) + " more");
    return joined(names, " and ");
  };
  std::string out = found(analysis);
  for (std::size_t named = count; named > 0 && code_points(out) > letters; --named)
    out = first(named);
  return out;
}

/// Root mean square of what the missing effects make in the profiles, "" where it is not known.
std::string size_of_missing(const Result& result) {
  const auto size = [](const std::optional<double>& before, const std::optional<double>& after) {
    return before && after && *before > *after
               ? std::optional(std::sqrt(*before * *before - *after * *after))
               : std::nullopt;
  };
  const auto um = size(result.declared->rms_um, result.final->rms_um),
             urad = size(result.declared->rms_urad, result.final->rms_urad);
  return um || urad ? ", " + size_text(um, urad, 2) + " rms" : "";
}

std::string left_over(const TraceResult& trace) {
  if (!trace.unnamed) return "";
  const Unnamed& left = *trace.unnamed;
  return ": " + size_text(left.rms_um, left.rms_urad) + " rms on " + left.profile;
}

std::string moved_by(const Shift& shift) {
  return shift.what + " by " + in_expanded_uncertainties(shift.in_expanded_uncertainties);
}

std::string what_was_missing(const Analysis& analysis) {
  const TraceResult& trace = *analysis.trace;
  const std::size_t count = found_effects(trace).size();
  const std::string names = found(analysis);
  const std::string lacked =
      "the model lacked " + (names.size() <= kFewLetters ? names : counted(count, "effect"));
  const std::optional<Shift> shift = largest_shift(analysis.result);
  if (!shift) return lacked + ", now in it";
  if (is_harmless(analysis)) return lacked + ", which changes none of these numbers";
  return lacked + ", which had moved " + moved_by(*shift);
}

std::string what_may_be_missing(const Analysis& analysis) {
  const std::string names = found(analysis);
  const std::string open =
      names.size() <= kFewLetters
          ? "the model lacks " + names +
                (names.size() < kShortNames ? ": the data cannot tell which" : "")
          : "the data cannot tell which effect the model lacks";
  const std::optional<Shift> shift = largest_shift(analysis.result);
  return shift ? open + ", and it moves " + moved_by(*shift) : open;
}

/// What the closed loop says, with the verdict in a word or two.
std::string say_finding(const Analysis& analysis, Summary& out) {
  const auto say = [&](Alarm alarm, const char* badge, std::string clause) {
    out.alarm = alarm;
    out.badge = badge;
    return clause;
  };
  const TraceResult& trace = *analysis.trace;
  const bool has_two =
      std::ranges::count(analysis.result.inputs, Role::fit, &InputSummary::role) == 2;
  if (!trace.blunders.empty())
    return say(Alarm::bad, "Blunder",
               "profile " + trace.blunders.front().profile + " disagrees with " +
                   (has_two ? "the other" : "the others") + ": " +
                   std::string(text_of(trace.blunders.front().what)) +
                   (has_two ? ", unless the other is wrong" : ""));
  if (trace.unfinished)
    return say(
        Alarm::bad, "Not finished",
        "the time limit ended the search before an effect could be named" + left_over(trace));
  switch (trace.verdict) {
    case TraceVerdict::nothing_missing:
      return say(Alarm::good, "Nothing missing",
                 "the model explains the profiles down to " + noise_of(analysis.result.crosscheck));
    case TraceVerdict::explained:
      if (!trace.rounds.empty() && trace.rounds.front().accepted == kInstrument)
        return say(Alarm::warn, "Instrument",
                   "surfaces share a residual: the instrument's error, not the slide's");
      return say(Alarm::good, "Explained", what_was_missing(analysis));
    case TraceVerdict::ambiguous:
      if (is_harmless(analysis)) {
        const std::string size = size_of_missing(analysis.result);
        return say(
            Alarm::plain, "Ambiguous, without harm",
            "a possible effect" + (size.empty() ? "" : size + ",") + " does not change this");
      }
      return say(Alarm::warn, "Ambiguous", what_may_be_missing(analysis));
    case TraceVerdict::not_identifiable:
      return say(Alarm::bad, "Not identifiable", "the data cannot tell what made this form");
    case TraceVerdict::unnamed:
      break;
  }
  return say(
      Alarm::bad, "Unnamed",
      (trace.unnamed && trace.unnamed->has_folded_wave ? "a folded wave is left"
                                                       : "no known effect explains what is left") +
          left_over(trace));
}

/// The error from the line through the end points; null where it is not known.
const StraightnessError* end_point_error(const Straightness& form) {
  const auto at = std::ranges::find_if(form.errors, [](const StraightnessError& error) {
    return error.line == ReferenceLineKind::end_point && is_known(error);
  });
  return at == form.errors.end() ? nullptr : &*at;
}

std::string straightness_of(const Result& result) {
  if (!result.final || !result.final->straightness) return "E_ZX is not in the model";
  const Straightness& form = *result.final->straightness;
  if (const StraightnessError* const error = end_point_error(form))
    return "E_ZX " + value_text(*error) + " µm";
  return "E_ZX is not determined" + (form.reason.empty() ? "" : ": " + form.reason);
}

/// Of several squarenesses which this is.
std::string of_several(const FittedParameter& squareness, const ModelResult& model) {
  const auto count = std::ranges::count_if(model.parameters, is_squareness);
  const std::size_t first = squareness.name.find('['), last = squareness.name.find(']');
  if (count < 2 || last == std::string::npos) return "";
  return " of " + squareness.name.substr(first + 1, last - first - 1) + ", the largest of " +
         std::to_string(count);
}

std::string squareness_of(const Result& result) {
  if (const FittedParameter* const p = result.final ? result.final->squareness() : nullptr)
    return is_known(*p) ? value_text(*p, kMicroradian) + " µm/m" + of_several(*p, *result.final)
                        : "not determined by these data";
  const auto is_face = [](const InputSummary& in) { return in.kind == Kind::face; };
  return std::ranges::any_of(result.inputs, is_face) ? "not in the model" : "needs a face";
}

/// The error that dominates; "" where nothing was determined.
std::string lead_of(const Result& result, bool with_size) {
  const FittedParameter* const angle = result.final->squareness();
  const bool has_angle = angle != nullptr && is_known(*angle);
  const auto& way = result.final->straightness;
  const bool has_form = way && end_point_error(*way) != nullptr;
  const std::string straightness = straightness_of(result), squareness = squareness_of(result);
  if (!angle && has_form)
    return "the slide is straight to " + straightness.substr(std::string("E_ZX ").size()) +
           parts_beside(result) + condition_in_brief(way->if_no);
  const Dominant& dominant = result.dominant;
  const auto& leader = dominant.by_fit ? dominant.by_fit : dominant.by_correlation;
  if (!dominant.doubt.empty() || !leader)
    return has_angle && has_form ? "no error clearly dominates" : "";
  const auto named = [](bool is_clear, const std::string& error) {
    return is_clear ? error + " dominates" : "no error clearly dominates";
  };
  if (motion_error_of(*leader) == MotionError::squareness && has_angle)
    return named(std::abs(*angle->value) > *angle->expanded_uncertainty,
                 effect_title(*leader) +
                     (angle->if_no.empty() ? "" : " or " + effect_titles(angle->if_no, " or ")) +
                     (with_size ? ", " + squareness + "," : ""));
  if (motion_error_of(*leader) == MotionError::straightness && has_form)
    return named(*way->end_point_um > way->expanded_uncertainty_um.value_or(0.0),
                 effect_title(*leader) + (with_size ? ", " + straightness + "," : ""));
  return "largest effect: " + effect_title(*leader);
}

/// Badge and sentence; what harms most comes first.
void say_verdict(const Analysis& analysis, Summary& out) {
  const auto say = [&](Alarm alarm, const char* badge, const char* sentence) {
    out.alarm = alarm;
    out.badge = badge;
    out.verdict = out.verdict_in_brief = sentence;
  };
  const Result& result = analysis.result;
  if (!result.final)
    return say(Alarm::plain, "Ranking only", "effects were ranked by correlation, none was fitted");
  if (!result.final->converged)
    return say(Alarm::bad, "Not converged", "no number of this report can be relied on");
  say(Alarm::plain, "Fitted", "no missing effect was looked for");
  std::string finding = analysis.trace ? say_finding(analysis, out) : out.verdict;
  if (is_contradicted(result.crosscheck) && analysis.trace &&
      (out.alarm == Alarm::good || out.alarm == Alarm::plain)) {
    out.badge = "Inconsistent";
    if (analysis.trace->verdict == TraceVerdict::nothing_missing)
      finding = "the model explains what was fitted down to " + noise_of(result.crosscheck);
  }
  std::vector<std::string> clauses = objections(result);
  if (!clauses.empty()) out.alarm = std::max(out.alarm, Alarm::warn);
  const bool harms = out.alarm == Alarm::warn || out.alarm == Alarm::bad;
  const bool has_blunder = analysis.trace && !analysis.trace->blunders.empty();
  if (harms) clauses.insert(has_blunder ? clauses.begin() : clauses.end(), finding);
  const std::string lead = lead_of(result, true);
  const bool has_room = !harms || code_points(joined(clauses, "; ") + lead) < kTwoLines;
  const bool leads = out.alarm != Alarm::bad && !lead.empty() && has_room;
  if (leads) clauses.push_back(lead);
  const std::size_t before_checks = clauses.size();
  const auto& angle = result.crosscheck.squareness;
  if (angle && angle->verdict == Consistency::consistent)
    clauses.emplace_back(shows_little(*angle) ? "the run-out does not contradict it"
                                              : "the run-out agrees in amount");
  if (!harms) clauses.push_back(finding);
  out.verdict = joined(clauses, "; ");
  if (clauses.size() > before_checks + (harms ? 0 : 1))  // the run-out is among the checks
    clauses.erase(clauses.begin() + static_cast<std::ptrdiff_t>(before_checks));
  if (leads) clauses[before_checks - 1] = lead_of(result, false);  // and the size in the result
  out.verdict_in_brief = joined(clauses, "; ");
  out.verdict_names_missing = analysis.trace && was_extended(analysis) &&
                              out.verdict.find(found(analysis)) != std::string::npos;
}

void say_missing(const Analysis& analysis, Summary& out) {
  out.missing = analysis.trace ? "nothing that these data show" : "not looked for";
  if (analysis.trace && analysis.trace->verdict == TraceVerdict::unnamed)
    out.missing = "nothing that has a name";
  if (analysis.trace && analysis.trace->unfinished)
    out.missing = "not known: the time limit ended the search";
  if (analysis.trace && !analysis.trace->blunders.empty())
    out.missing = "not looked for while a profile has a blunder";
  if (analysis.result.final && !analysis.result.final->converged)
    out.missing = "not known: the fit did not converge";
  else if (analysis.trace && is_contradicted(analysis.result.crosscheck) &&
           analysis.trace->verdict == TraceVerdict::nothing_missing)
    out.missing = "nothing that the fitted profiles show";
  out.missing_in_brief = out.missing;
  if (!was_extended(analysis)) return;
  out.has_missing = true;
  const auto shift = largest_shift(analysis.result);
  const bool moved = shift && !is_harmless(analysis);
  const std::string what =
      moved ? ", which moved " + moved_by(*shift) : size_of_missing(analysis.result);
  const std::size_t left = kBoxText - std::min(kBoxText, code_points(what));
  out.missing = found(analysis) + what;
  out.missing_in_brief = found_in_brief(analysis, left) + what;
}

}  // namespace

Summary summary_of(const Analysis& analysis) {
  const Result& result = analysis.result;
  Summary out;
  std::vector<std::string> held;
  for (const Conformity& each : result.conformity) {
    const bool fails = each.verdict == ConformityVerdict::does_not_conform;
    held.push_back(each.what + " " + (fails ? "DOES NOT CONFORM" : verdict_text(each.verdict)) +
                   condition(result, each));
  }
  out.conformity = joined(held, "; ");
  const bool all_conform = std::ranges::all_of(result.conformity, [&](const Conformity& each) {
    return each.verdict == ConformityVerdict::conforms && condition(result, each).empty();
  });
  if (all_conform && held.size() > 1) {
    std::vector<std::string> what;
    for (const Conformity& each : result.conformity) what.push_back(each.what);
    out.conformity = joined(what, " and ") + " conform";
  }
  say_verdict(analysis, out);
  out.straightness = straightness_of(result);
  out.squareness = squareness_of(result);
  const bool has_curve = out.straightness.starts_with("E_ZX ") && out.straightness.ends_with("µm");
  const FittedParameter* const angle = result.final ? result.final->squareness() : nullptr;
  out.result = out.straightness +
               (has_curve ? " (end points)" + parts_beside(result) +
                                condition_in_brief(result.final->straightness->if_no)
                          : "") +
               "; squareness " + out.squareness + (angle ? condition(angle->if_no) : "");
  if (!result.final) out.result = "none: nothing was fitted";
  if (result.final && !result.final->converged)
    out.result = "not determined: the fit did not converge";
  out.unseen = moved_unseen(analysis);
  out.bent_unseen = bent_unseen(analysis);
  if (const auto& model = result.final; model && model->straightness)
    out.same = effect_titles(model->straightness->if_no, ", ");
  say_crosscheck(result, out);
  say_missing(analysis, out);
  out.next = next_step(analysis);
  out.has_next = out.next != kNothingToDo;
  out.next_in_brief =
      code_points(out.next) > kBoxText ? out.next.substr(0, out.next.find("; ")) : out.next;
  return out;
}

}  // namespace slideway
