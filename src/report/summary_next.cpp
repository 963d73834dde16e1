#include <algorithm>
#include <cmath>
#include <set>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/effects/channel.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/report/number.hpp"
#include "slideway/trace/plan.hpp"
#include "slideway/trace/unseen.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

/// What numbers are in doubt, and what to do about it.
namespace slideway {
namespace {

/// Of the declared numbers, in U: what is no alarm.
double harmless_shift(const TraceResult& trace) {
  for (const auto& [name, value] : trace.gates)
    if (name == "harmless_shift") return value;
  return Gates{}.harmless_shift;
}

/// The titles of same_columns_as().
std::string one_with(MotionError error, const TraceResult& trace) {
  return effect_titles(same_columns_as(error, trace), ", ");
}

/// By how much that is: "2.6 µm/m". REQUIRES one.
std::string most_unseen(const TraceResult& trace) {
  return one_with(MotionError::squareness, trace).empty()
             ? number(*worst_unseen(trace, &DetectionLimit::squareness_rad)->squareness_rad /
                          kMicroradian,
                      2) +
                   " µm/m"
             : "any amount";
}

/// The cut to make next; "slideway plan" where none has been tried on paper.
std::string planned(const Analysis& analysis) {
  return analysis.trace && analysis.trace->next_cut ? cut_to_make(*analysis.trace->next_cut)
                                                    : "slideway plan tries further cuts on paper";
}

/// Whether that cut determines what these data do not.
bool cut_determines(const Analysis& analysis) {
  return analysis.trace && analysis.trace->next_cut &&
         analysis.trace->next_cut->reason.starts_with(kDetermines);
}

/// What to do about checks that failed; "": none has. A wrong profile among the fitted ones comes
/// first: it bends the predictions of those held out.
std::string reconciled(const Crosscheck& checks) {
  const auto apart = [](const std::string& profile) {
    return "find what sets " + profile + " apart: its setup, its cut or its reading";
  };
  std::set<std::vector<std::string>> pairs;
  for (const ProfileCheck& check : checks.profiles)
    if (contradicts(check)) pairs.insert(check.profiles);
  if (const std::string odd = odd_profile(pairs); !odd.empty()) return apart(odd);
  for (const ProfileCheck& check : checks.profiles)
    if (contradicts(check))
      return "find why " + who_of(check) + " disagree: their setups, cuts or readings";
  for (const HeldOutCheck& check : checks.held_out)
    if (contradicts(check)) return apart(check.profile);
  if (checks.squareness && checks.squareness->verdict == Consistency::inconsistent)
    return "look for another cause: the squareness cannot have made this form";
  return "";
}

/// Whether a slide is a curve, and only one fitted profile shows it.
bool is_lone_curve(const Result& result) {
  return result.final->straightness && result.final->straightness->form &&
         std::ranges::count(result.inputs, Role::fit, &InputSummary::role) == 1;
}

std::string over(const std::string& variable) {
  return variable.empty() ? "" : " over " + variable;
}

/// Whether E_ZX holds an effect of the catalogue that is so, as far as the data tell.
template <typename Is>
bool holds(const Result& result, Is&& is) {
  const auto& form = result.final->straightness;
  return form && std::ranges::any_of(form->if_no, [&](const std::string& name) {
           return std::ranges::count(effect_names(), name) > 0 && is(specimen(name).description());
         });
}

/// A log that may be the cause of what has no name, and was not looked at; "": none.
std::string log_left_aside(const TraceResult& trace) {
  if (trace.verdict != TraceVerdict::unnamed) return "";
  for (const auto& [effect, needs] : trace.not_testable)
    if (needs.starts_with(kLogLacks))
      return in_words(effect) + " may be the cause: it needs " + needs;
  return "";
}

/// A formula that leaves less than half of what has no name, in all profiles; "": none.
std::string described(const TraceResult& trace) {
  if (trace.verdict != TraceVerdict::unnamed || !trace.unnamed || trace.unnamed->forms.empty())
    return "";
  const UnnamedForm& best = trace.unnamed->forms.front();
  const auto halved = [](const std::optional<double>& before, const std::optional<double>& after) {
    return before && after && *after < 0.5 * *before;
  };
  if (!best.profiles.empty() || (!halved(best.before_rms_um, best.after_rms_um) &&
                                 !halved(best.before_rms_urad, best.after_rms_urad)))
    return "";
  return "look for the candidate of --full that describes what is left: " + best.form +
         over(variable_of(*trace.unnamed));
}

/// What the closed loop leaves to do; "": nothing.
std::string next_of_loop(const Analysis& analysis) {
  const TraceResult& trace = *analysis.trace;
  if (trace.verdict == TraceVerdict::ambiguous && is_harmless(analysis)) return "";
  if (trace.unfinished) return "run it again with a longer time limit";
  if (!trace.advice.empty()) return with_titles(trace.advice.front());
  if (trace.verdict == TraceVerdict::unnamed && trace.unnamed && !trace.unnamed->forms.empty())
    return "formulas" + over(variable_of(*trace.unnamed)) +
           " describe what is left: --full prints each as a candidate to look for";
  if (trace.verdict == TraceVerdict::unnamed)
    return "look at the residual on the page: where the structure is, and over what it repeats";
  return "";
}

}  // namespace

bool is_harmless(const Analysis& analysis) {
  const std::optional<Shift> shift = largest_shift(analysis.result);
  return shift && std::abs(shift->in_expanded_uncertainties) <= harmless_shift(*analysis.trace);
}

bool contradicts(const ProfileCheck& check) { return check.verdict == Consistency::inconsistent; }
bool contradicts(const HeldOutCheck& check) {
  return check.verdict == HeldOutVerdict::does_not_fit;
}

bool is_of_all(const ProfileCheck& check) { return check.profiles.size() > 2; }

std::string who_of(const ProfileCheck& check) {
  return is_of_all(check) ? "all profiles" : joined(check.profiles, " and ");
}

std::string each_alone(const ProfileCheck& check) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < check.value_um.size(); ++i)
    out.push_back(with_uncertainty(check.value_um[i], check.U_um[i]));
  return out.empty() ? "" : joined(out, " and ") + " µm";
}

std::string cut_to_make(const NextCut& cut) {
  return cut.what + ", by slideway plan; " + with_titles(cut.reason);
}

std::string moved_unseen(const Analysis& analysis) {
  if (!analysis.trace) return "";
  const DetectionLimit* const worst =
      worst_unseen(*analysis.trace, &DetectionLimit::squareness_rad);
  if (!worst) return "";
  const std::string same = one_with(MotionError::squareness, *analysis.trace);
  return (same.empty() ? "" : "by any amount: " + same + "; ") + "by up to " +
         number(*worst->squareness_rad / kMicroradian, 2) + " µm/m: " + effect_title(worst->effect);
}

std::string bent_unseen(const Analysis& analysis) {
  const auto& model = analysis.result.final;
  if (!analysis.trace || !model || !model->straightness || !model->straightness->end_point_um)
    return "";
  const DetectionLimit* const worst =
      worst_unseen(*analysis.trace, &DetectionLimit::straightness_um);
  return worst ? "by up to " + number(*worst->straightness_um, 2) +
                     " µm: " + effect_title(worst->effect)
               : "";
}

std::string condition(const std::vector<std::string>& if_no) {
  return if_no.empty() ? "" : ", if no " + effect_titles(if_no, " or ");
}

std::string condition_in_brief(std::vector<std::string> if_no) {
  if (if_no.size() < 3) return condition(if_no);
  const std::string more = std::to_string(if_no.size() - 1) + " more";
  return condition({if_no.front()}) + " or " + more;
}

std::string next_step(const Analysis& analysis) {
  const Result& result = analysis.result;
  if (!result.final) return "slideway identify, which fits and looks for what is missing";
  if (!result.final->converged)
    return "declare fewer effects or other priors: the fit must converge";
  if (analysis.trace && !analysis.trace->blunders.empty()) return analysis.trace->advice.front();
  if (analysis.trace)
    for (std::string next : {log_left_aside(*analysis.trace), described(*analysis.trace)})
      if (!next.empty()) return next;
  if (std::string next = reconciled(result.crosscheck); !next.empty()) return next;
  for (const UndeterminedDirection* direction : open_directions(*result.final))
    if (!direction->advice.empty()) {
      const std::string advice = with_titles(direction->advice);
      return cut_determines(analysis) ? planned(analysis) + "; or " + advice
                                      : advice + "; " + planned(analysis);
    }
  if (!analysis.trace) return "slideway identify, which looks for what the model lacks";
  if (std::string next = next_of_loop(analysis); !next.empty()) return next;
  if (is_lone_curve(result))
    return "read it once more, back: in one trace a drift looks like the slide's form";
  if (holds(result,
            [](const Description& effect) { return effect.motion == MotionError::squareness; }))
    return "declare the squareness, too: every machine has one, and E_ZX holds it";
  if (holds(result, is_drift_of_instrument))
    return "read it once more, back, with time_column: read one way, a drift of the zero looks "
           "like the slide's form";
  if (holds(result, [](const Description& effect) {
        return effect.of_instrument && effect.variable == IndependentVariable::slide;
      }))
    return "read it once more, the straightedge turned over (reversed = true): its form looks like "
           "the slide's";
  if (!may_be_moved_unseen(*result.final, *analysis.trace)) return kNothingToDo;
  return planned(analysis) + "; unseen effects may move the squareness by " +
         most_unseen(*analysis.trace);
}

}  // namespace slideway
