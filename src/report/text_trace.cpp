#include <algorithm>
#include <cmath>
#include <sstream>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "slideway/trace/analysis_fields.hpp"
#include "slideway/trace/unseen.hpp"
#include "summary.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

std::string last_name(const std::string& name) { return name.substr(name.rfind('.') + 1); }

std::string verdict(const TraceResult& trace) {
  if (!trace.blunders.empty())
    return "profile " + trace.blunders.front().profile +
           " disagrees with the others; no effect was looked for.";
  if (trace.unfinished) return "the time limit ended the search before an effect could be named.";
  switch (trace.verdict) {
    case TraceVerdict::nothing_missing:
      return "nothing is missing that these data tell from noise (lack of fit p = " +
             probability(trace.lack_of_fit_p) + ").";
    case TraceVerdict::explained:
      return "an effect was missing and is named:";
    case TraceVerdict::ambiguous:
      return "an effect is missing, and these data cannot tell it from its rivals:";
    case TraceVerdict::not_identifiable:
      return "a form is there, but these data cannot tell what makes it:";
    case TraceVerdict::unnamed:
      break;
  }
  return std::string("structure is left that no effect of the catalogue explains") +
         (trace.rounds.empty() ? "." : ", beside:");
}

std::string round(const TraceRound& round, std::size_t index) {
  std::string text = item(
      std::to_string(index + 1) + ". " + effect_titles(names_of(round), " or ") + ": residual " +
      residual_change(round.before_rms_um, round.after_rms_um, round.before_rms_urad,
                      round.after_rms_urad) +
      ", difference in BIC " + number(round.delta_bic, 3) + ", p " +
      (round.p_value < 1e-4 ? "" : "= ") + probability(round.p_value) + ", chosen by " +
      number(100.0 * round.stability, 2) + " % of the resamples");
  if (const std::string change =
          residual_change(round.before_holdout_rms_um, round.after_holdout_rms_um, {}, {});
      !change.empty())
    text += paragraph("     ", "on profiles left out of the fit " + change);
  for (const FittedParameter& p : round.parameters)
    text += paragraph("     ", last_name(p.name) + " = " + value_text(p) + " " + unit_text(p.unit));
  return text;
}

std::string left_over(const Unnamed& left) {
  std::string text = "Left without a name: " + size_text(left.rms_um, left.rms_urad) + " rms, " +
                     size_text(left.pv_um, left.pv_urad) + " peak to valley on " + left.profile +
                     " (lack of fit p " + (left.p_value < 1e-4 ? "" : "= ") +
                     probability(left.p_value) + "), largest from " + number(left.from_mm, 4) +
                     " to " + number(left.to_mm, 4) + " mm";
  if (!left.clock.empty())
    text += "; best described as " + likeness(left) + ", correlation length " +
            number(left.correlation_length, 2) + " " + unit_text(left.correlation_unit);
  if (left.has_folded_wave) text += "; with a wave that the low band may have folded";
  if (left.dominant_period_mm)
    text += "; dominant period " + number(*left.dominant_period_mm, 3) + " mm";
  if (left.odd_share)
    text += "; " + number(100.0 * *left.odd_share, 2) + " % of it odd about the axis";
  return item(text + ". It is not counted as an improvement.");
}

std::string form(const UnnamedForm& form, std::size_t index) {
  std::string text =
      item("Form " + std::to_string(index + 1) + ", " + form.form + ": " + form.formula +
           (form.profiles.empty() ? "" : ", in " + joined(form.profiles)) +
           (form.instead_of.empty() ? "" : ", in place of " + effect_title(form.instead_of)) +
           ": residual " +
           residual_change(form.before_rms_um, form.after_rms_um, form.before_rms_urad,
                           form.after_rms_urad) +
           ", difference in BIC " + number(form.delta_bic, 3));
  if (const std::string change =
          residual_change(form.before_holdout_rms_um, form.after_holdout_rms_um, {}, {});
      !change.empty())
    text += paragraph("     ", "on profiles left out of the fit " + change);
  for (const FittedParameter& p : form.parameters)
    text += paragraph("     ", last_name(p.name) + " = " + value_text(p) + " " + unit_text(p.unit));
  return text;
}

/// What describes the rest, and the block of the best to paste.
std::string forms(const Unnamed& left) {
  if (left.forms.empty()) return "";
  std::string text;
  for (std::size_t i = 0; i < left.forms.size(); ++i) text += form(left.forms[i], i);
  text += note("A form describes what is left and is no cause. To confirm one: " +
               with_titles(left.to_confirm) + ".");
  text += item("To look for form 1 in the next run, as a cause of your own:");
  std::istringstream lines(left.forms.front().candidate);
  for (std::string line; std::getline(lines, line);) text += "    " + line + "\n";
  return text;
}

std::string extremes(const DetectionLimit& limit) {
  std::vector<double> sizes;
  for (const LimitAtShape& each : limit.by_shape)
    if (each.value) sizes.push_back(*each.value);
  if (sizes.empty()) return "";
  const auto [least, most] = std::ranges::minmax(sizes);
  return number(least, 2) + " to " + number(most, 2);
}

std::string limits(const TraceResult& trace) {
  if (trace.detection_limits.empty()) return "";
  const auto any = [&](MovedUnseen moved) {
    return std::ranges::any_of(trace.detection_limits,
                               [&](const auto& limit) { return (limit.*moved).has_value(); });
  };
  const bool angle = any(&DetectionLimit::squareness_rad),
             form = any(&DetectionLimit::straightness_um);
  TextTable table(
      {"effect", "found from", "other shapes", angle ? "µm/m" : "", form ? "µm" : "", "at"},
      {TextColumn::text, TextColumn::number, TextColumn::number, TextColumn::number,
       TextColumn::number, TextColumn::text});
  for (const DetectionLimit& limit : trace.detection_limits)
    table.add({effect_title(limit.effect),
               limit.value ? number(*limit.value, 2) + " " + unit_text(limit.unit) : "at no size",
               extremes(limit),
               limit.squareness_rad ? number(*limit.squareness_rad / kMicroradian, 2) : "",
               limit.straightness_um ? number(*limit.straightness_um, 2) : "", limit.at});
  std::vector<std::string> moved;
  if (angle) moved.emplace_back("Δβxz");
  if (form) moved.emplace_back("E_ZX");
  return item("Sizes found with 80 % probability" +
              (moved.empty() ? ":"
                             : ", and the most that what is just not seen moves " +
                                   joined(moved, " and ") + ":")) +
         table.text();
}

/// One line for each thing that is needed.
std::string untestable(const TraceResult& trace) {
  std::vector<std::string> needs;
  for (const NotTestable& each : trace.not_testable)
    if (std::ranges::find(needs, each.needs) == needs.end()) needs.push_back(each.needs);
  std::string text;
  for (const std::string& need : needs) {
    std::vector<std::string> effects;
    for (const NotTestable& each : trace.not_testable)
      if (each.needs == need) effects.push_back(each.effect);
    text += note("Not testable: " + effect_titles(effects, ", ") + "; needs " + need + ".");
  }
  return text;
}

std::string cross_validation(const TraceResult& trace) {
  if (!trace.gain) return "";
  std::vector<std::string> gaps;
  for (const BlockPrediction& each : trace.cross_validation)
    gaps.push_back(number(each.block_mm, 3) + " mm " +
                   residual_change(each.before_rms_um, each.after_rms_um, each.before_rms_urad,
                                   each.after_rms_urad));
  return item("Predicted over gaps of " + joined(gaps, ", ") + ": the gain is " +
              std::string(text_of(*trace.gain)) + ".");
}

std::string gates(const TraceResult& trace) {
  std::vector<std::string> values;
  for (const auto& [gate, value] : trace.gates) values.push_back(gate + " " + number(value, 4));
  std::string text = values.empty() ? "" : item("Gates: " + joined(values) + ".");
  if (trace.fragile)
    text += item("With " + trace.fragile->gate + " = " + number(trace.fragile->value, 4) +
                 " the verdict would be " + std::string(text_of(trace.fragile->verdict)) + ".");
  return text;
}

}  // namespace

std::string trace_text(const TraceResult& trace) {
  std::string text = heading("Closed loop: " + verdict(trace));
  for (std::size_t i = 0; i < trace.rounds.size(); ++i) text += round(trace.rounds[i], i);
  text += cross_validation(trace);
  if (trace.unnamed) text += left_over(*trace.unnamed) + forms(*trace.unnamed);
  for (const std::string& line : trace.advice) text += note(with_titles(line));
  if (trace.next_cut) text += note("To measure next: " + cut_to_make(*trace.next_cut));
  for (const NotSeparable& each : trace.not_separable)
    text += note(effect_title(each.effect) + " and " + with_titles(each.same_as) +
                 " are one column here: not separable");
  for (const TriedEffect& tried : trace.refused)
    if (tried.refused && tried.delta_bic < -10.0)
      text += note(effect_title(term_name(tried.effect, tried.profiles)) +
                   " was refused: " + with_titles(*tried.refused));
  if (!trace.not_looked_at.empty())
    text += note("Not looked at within the time limit: " + joined(trace.not_looked_at) + ".");
  return text + untestable(trace) + limits(trace) + gates(trace);
}

}  // namespace slideway
