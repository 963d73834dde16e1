#include "summary.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/identifiability.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

constexpr std::size_t kFewLetters = 38;            // names that leave room for a sentence
constexpr std::size_t kShortNames = 30;            // and for its end
constexpr std::size_t kBoxText = kLineWidth - 11;  // beside the label

/// Of the declared numbers, in U: what is no alarm.
double harmless_shift(const TraceResult& trace) {
  for (const auto& [name, value] : trace.gates)
    if (name == "harmless_shift") return value;
  return Gates{}.harmless_shift;
}

bool is_harmless(const Analysis& analysis) {
  const std::optional<Shift> shift = largest_shift(analysis.result);
  return shift && std::abs(shift->in_expanded_uncertainties) <= harmless_shift(*analysis.trace);
}

std::string in_expanded_uncertainties(double shift) {
  return number(std::round(100.0 * shift) / 100.0 + 0.0, 2) + " U";  // no -0
}

std::string found(const TraceResult& trace) {
  std::vector<std::string> out;
  for (const TraceRound& round : trace.rounds) {
    out.push_back(effect_titles(names_of(round), " or "));
  }
  return joined(out, " and ");
}

/// The same in so many letters, if it can be: rivals are counted, then the last effects, and the
/// rivals are left out.
std::string found_in_brief(const TraceResult& trace, std::size_t letters) {
  const std::size_t count = trace.rounds.size();
  const auto first = [&](std::size_t named, bool with_rivals) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < named; ++i) {
      const TraceRound& round = trace.rounds[i];
      const std::size_t rivals = with_rivals ? round.ambiguous_with.size() : 0;
      names.push_back(effect_title(round.accepted) +
                      (rivals > 0 ? " (" + counted(rivals, "rival") + ")" : std::string()));
    }
    if (named < count) names.push_back(std::to_string(count - named) + " more");
    return joined(names, " and ");
  };
  std::string out = found(trace);
  for (std::size_t named = count; named > 0 && code_points(out) > letters; --named)
    out = first(named, true);
  return code_points(out) > letters ? first(1, false) : out;
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

void say_verdict(const Analysis& analysis, Summary& out) {
  const auto say = [&](Alarm alarm, const char* badge, std::string sentence) {
    out.alarm = alarm;
    out.badge = badge;
    out.verdict = std::move(sentence);
  };
  const std::optional<ModelResult>& model = analysis.result.final;
  if (!model)
    return say(Alarm::plain, "Ranking only", "effects were ranked by correlation, none was fitted");
  if (!model->converged)
    return say(Alarm::bad, "Not converged", "no number of this report can be relied on");
  if (!analysis.trace)
    return say(Alarm::plain, "Fitted", "the declared model; no missing effect was looked for");
  const TraceResult& trace = *analysis.trace;
  if (!trace.blunders.empty())
    return say(Alarm::bad, "Blunder",
               "profile " + trace.blunders.front().profile + " disagrees with the others: " +
                   std::string(text_of(trace.blunders.front().what)));
  const std::string names = found(trace);
  const bool few = names.size() <= kFewLetters;
  switch (trace.verdict) {
    case TraceVerdict::nothing_missing:
      return say(Alarm::good, "Nothing missing", "the model explains the profiles down to noise");
    case TraceVerdict::explained:
      if (!trace.rounds.empty() && trace.rounds.front().accepted == kInstrument)
        return say(Alarm::warn, "Instrument",
                   "surfaces share a residual: the instrument's error, not the slide's");
      return say(
          Alarm::good, "Explained",
          (few ? names + " was" : "what is named below was") + " missing and is in the model now");
    case TraceVerdict::ambiguous:
      if (is_harmless(analysis))
        return say(Alarm::plain, "Ambiguous, without harm",
                   "what is missing moves nothing by " + number(harmless_shift(trace), 2) + " U");
      return say(Alarm::warn, "Ambiguous",
                 few ? names + " is missing" +
                           (names.size() < kShortNames ? ": the data cannot tell which" : "")
                     : "the data cannot tell which effect is missing");
    case TraceVerdict::not_identifiable:
      return say(Alarm::bad, "Not identifiable", "the data cannot tell what made this form");
    case TraceVerdict::unnamed:
      break;
  }
  say(Alarm::bad, "Unnamed", "no known effect explains what is left" + left_over(trace));
}

std::string straightness_of(const Result& result) {
  if (!result.final || !result.final->straightness) return "E_ZX is not in the model";
  const Straightness& form = *result.final->straightness;
  for (const StraightnessError& error : form.errors)
    if (error.line == ReferenceLineKind::end_point && is_known(error))
      return "E_ZX " + value_text(error) + " µm";
  return "E_ZX is not determined" + (form.reason.empty() ? "" : ": " + form.reason);
}

const FittedParameter* squareness_parameter(const Result& result) {
  if (!result.final) return nullptr;
  const auto found = std::ranges::find_if(result.final->parameters, is_squareness);
  return found == result.final->parameters.end() ? nullptr : &*found;
}

std::string squareness_of(const Result& result) {
  if (const FittedParameter* const p = squareness_parameter(result))
    return is_known(*p) ? value_text(*p, kMicroradian) + " µm/m" : "not determined by these data";
  const auto is_face = [](const InputSummary& in) { return in.kind == Kind::face; };
  return std::ranges::any_of(result.inputs, is_face) ? "not in the model" : "needs a face";
}

void say_crosscheck(const Result& result, Summary& out) {
  const Crosscheck& checks = result.crosscheck;
  std::vector<std::string> parts, consistent;
  const auto& angle = checks.squareness;
  if (angle && angle->En) {
    QuantityValue indirect;
    indirect.value = angle->indirect_rad;
    indirect.expanded_uncertainty = angle->indirect_U_rad;
    const bool is_consistent = angle->verdict != Consistency::inconsistent;
    (is_consistent ? consistent : parts)
        .push_back(std::string(is_consistent ? "consistent" : "INCONSISTENT") +
                   " with the run-out, Eq. (21): " + value_text(indirect, kMicroradian) +
                   " µm/m, E_n = " + number(*angle->En, 2));
  }
  for (const ProfileCheck& check : checks.profiles)
    if (check.verdict == Consistency::inconsistent)
      parts.push_back("INCONSISTENT: " + check.what + " of " + joined(check.profiles, " and ") +
                      (check.En ? ", E_n = " + number(*check.En, 2) : ""));
  for (const HeldOutCheck& check : checks.held_out) {
    const bool fits = check.verdict == HeldOutVerdict::fits;
    (fits ? consistent : parts)
        .push_back(check.profile + ", held out, " +
                   (fits ? "fits" : "DOES NOT FIT at " + number(check.at_mm, 4) + " mm"));
  }
  std::ranges::move(consistent, std::back_inserter(parts));
  out.has_crosscheck = !parts.empty();
  if (parts.empty())
    parts.push_back("none" + (angle && !angle->reason.empty() ? ": " + angle->reason : ""));
  out.crosscheck = joined(parts, "; ");
}

void say_missing(const Analysis& analysis, Summary& out) {
  out.missing = analysis.trace ? "nothing that these data show" : "not looked for";
  if (analysis.trace && analysis.trace->verdict == TraceVerdict::unnamed)
    out.missing = "nothing that has a name";
  if (analysis.trace && !analysis.trace->blunders.empty())
    out.missing = "not looked for while a profile has a blunder";
  out.missing_in_brief = out.missing;
  if (!was_extended(analysis)) return;
  out.has_missing = true;
  std::string moved, size;
  const auto shift = largest_shift(analysis.result);
  if (shift && std::abs(shift->in_expanded_uncertainties) > harmless_shift(*analysis.trace))
    moved = "moved " + shift->what + " by " +
            in_expanded_uncertainties(shift->in_expanded_uncertainties) + ": ";
  else
    size = size_of_missing(analysis.result);
  const std::size_t left = kBoxText - std::min(kBoxText, code_points(moved + size));
  out.missing = moved + found(*analysis.trace) + size;
  out.missing_in_brief = moved + found_in_brief(*analysis.trace, left) + size;
}

std::string next_step(const Analysis& analysis) {
  const Result& result = analysis.result;
  if (!result.final) return "slideway identify, which fits and looks for what is missing";
  if (analysis.trace && !analysis.trace->blunders.empty()) return analysis.trace->advice.front();
  for (const UndeterminedDirection* direction : open_directions(*result.final))
    if (!direction->advice.empty()) return with_titles(direction->advice);
  if (analysis.trace && analysis.trace->verdict == TraceVerdict::ambiguous && is_harmless(analysis))
    return "none is needed for these numbers";
  const auto& angle = result.crosscheck.squareness;
  if (angle && angle->verdict == Consistency::inconsistent)
    return "look for another cause: the squareness cannot have made this form";
  if (analysis.trace && !analysis.trace->advice.empty())
    return with_titles(analysis.trace->advice.front());
  if (!analysis.trace) return "slideway identify, which looks for what the model lacks";
  if (analysis.trace->verdict == TraceVerdict::unnamed)
    return "look at the residual on the page: where the structure is, and over what it repeats";
  return "none is needed for these numbers";
}

}  // namespace

std::vector<std::string> names_of(const TraceRound& round) {
  std::vector<std::string> names{term_name(round.accepted, round.profiles)};
  names.insert(names.end(), round.ambiguous_with.begin(), round.ambiguous_with.end());
  return names;
}

std::string effect_title(const std::string& name) {
  if (name == kUnnamedRival) return "something without a name";
  std::string title = name;
  std::replace(title.begin(), std::ranges::find(title, '['), '_', ' ');
  return title;
}

std::string effect_titles(const std::vector<std::string>& names, const std::string& separator) {
  std::vector<std::string> out;
  for (const std::string& name : names) out.push_back(effect_title(name));
  return joined(out, separator);
}

std::string parameter_title(const FittedParameter& parameter) {
  const std::size_t dot = parameter.name.rfind('.');
  if (dot == std::string::npos) return parameter.name;
  return effect_title(parameter.name.substr(0, dot)) + " " +
         (parameter.symbol.empty() ? parameter.name.substr(dot + 1) : parameter.symbol);
}

std::string with_titles(std::string text) {
  const auto is_word = [](char c) { return c == '_' || c == '.' || (c >= 'a' && c <= 'z'); };
  for (const std::string& name : effect_names()) {
    if (name.find('_') == std::string::npos) continue;
    for (std::size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += name.size()) {
      const std::size_t end = at + name.size();
      const bool alone = (at == 0 || !is_word(text[at - 1])) &&
                         (end == text.size() || text[end] != '_') &&
                         (end + 1 >= text.size() || text[end] != '.' || !is_word(text[end + 1]));
      if (alone) text.replace(at, name.size(), effect_title(name));
    }
  }
  return text;
}

bool is_squareness(const FittedParameter& parameter) {
  return motion_error_of(parameter.name) == MotionError::squareness;
}

bool is_vertical(const std::string& effect) {
  return motion_error_of(effect) == MotionError::vertical_straightness;
}

std::string likeness(const Unnamed& left) {
  constexpr const char* kVariables[][2] = {{"r", "the slide coordinate"},
                                           {"t", "the cutting time"},
                                           {"s", "the cutting distance"},
                                           {"X", "the trace position"}};
  for (const auto& [symbol, variable] : kVariables)
    if (left.clock == symbol) return std::string("a curve over ") + variable;
  return left.clock == "per profile" ? "a curve of its own in every profile"
                                     : "a curve in " + left.clock;
}

std::string in_sentence(std::string text) {
  if (text.empty()) return text;
  if (text.front() >= 'a' && text.front() <= 'z') text.front() += 'A' - 'a';
  return text.back() == '.' ? text : text + ".";
}

std::string value_of(const Assumption& assumption) {
  if (!nlohmann::json::accept(assumption.value)) return assumption.value;
  return nlohmann::ordered_json::parse(assumption.value).dump();
}

std::optional<Shift> largest_shift(const Result& result) {
  if (!result.declared || !result.final) return std::nullopt;
  std::optional<Shift> most;
  const auto compare = [&](const std::string& what, const QuantityValue& before,
                           const QuantityValue& after) {
    if (!is_known(after) || !before.value || !(*after.expanded_uncertainty > 0.0)) return;
    const double shift = (*before.value - *after.value) / *after.expanded_uncertainty;
    if (!most || std::abs(shift) > std::abs(most->in_expanded_uncertainties)) most = {what, shift};
  };
  for (const FittedParameter& before : result.declared->parameters)
    if (const FittedParameter* const after = result.final->find(before.name))
      compare(parameter_title(before), before, *after);
  if (result.declared->straightness && result.final->straightness) {
    const auto &before = result.declared->straightness->errors,
               &after = result.final->straightness->errors;
    for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i)
      if (after[i].line == ReferenceLineKind::end_point) compare("E_ZX", before[i], after[i]);
  }
  return most;
}

bool was_extended(const Analysis& analysis) {
  return analysis.trace && !analysis.trace->rounds.empty() && analysis.result.declared &&
         analysis.result.final;
}

std::string residual_change(const std::optional<double>& before_um,
                            const std::optional<double>& after_um,
                            const std::optional<double>& before_urad,
                            const std::optional<double>& after_urad) {
  const auto change = [](double before, double after, const char* unit) {
    return number(before, 3) + " → " + number(after, 3) + unit;
  };
  std::vector<std::string> out;
  if (before_um && after_um) out.push_back(change(*before_um, *after_um, " µm"));
  if (before_urad && after_urad) out.push_back(change(*before_urad, *after_urad, " µrad"));
  return joined(out);
}

std::vector<const UndeterminedDirection*> open_directions(const ModelResult& model) {
  std::vector<const UndeterminedDirection*> out;
  for (const UndeterminedDirection& direction : model.identifiability.unidentifiable)
    if (!std::ranges::all_of(direction.combination,
                             [](const auto& term) { return fixed_by_convention(term.first); }))
      out.push_back(&direction);
  return out;
}

Summary summary_of(const Analysis& analysis) {
  Summary out;
  say_verdict(analysis, out);
  out.straightness = straightness_of(analysis.result);
  out.squareness = squareness_of(analysis.result);
  say_crosscheck(analysis.result, out);
  say_missing(analysis, out);
  out.next = next_step(analysis);
  out.next_in_brief =
      code_points(out.next) > kBoxText ? out.next.substr(0, out.next.find("; ")) : out.next;
  return out;
}

}  // namespace slideway
