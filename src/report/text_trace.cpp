#include <algorithm>
#include <cmath>

#include "slideway/base/text.hpp"
#include "slideway/report/layout.hpp"
#include "slideway/report/number.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

using Column = TextTable::Column;

std::string unit_of(const FittedParameter& p) { return p.unit == "1" ? "" : " " + p.unit; }

std::string value_of(const FittedParameter& p) {
  if (!p.value) return "not determined";
  const auto& uncertainty =
      p.expanded_uncertainty ? p.expanded_uncertainty : p.standard_uncertainty;
  if (!uncertainty) return number(*p.value, 4) + unit_of(p);
  return with_uncertainty(*p.value, *uncertainty) + unit_of(p);
}

std::string last_name(const std::string& name) { return name.substr(name.rfind('.') + 1); }

std::string change(double before, double after, const std::string& unit) {
  return number(before, 4) + " -> " + number(after, 4) + unit;
}

std::string residual_change(const TraceRound& round) {
  std::vector<std::string> out;
  if (round.before_rms_um && round.after_rms_um)
    out.push_back(change(*round.before_rms_um, *round.after_rms_um, " µm"));
  if (round.before_rms_urad && round.after_rms_urad)
    out.push_back(change(*round.before_rms_urad, *round.after_rms_urad, " µrad"));
  return joined(out);
}

std::string verdict(const TraceResult& trace) {
  if (trace.verdict == TraceVerdict::nothing_missing)
    return "nothing is missing that these data tell from noise (lack of fit p = " +
           probability(trace.lack_of_fit_p) + "; structure is what is below 0.001).";
  if (trace.verdict == TraceVerdict::explained) return "an effect was missing and is named:";
  if (trace.verdict == TraceVerdict::ambiguous)
    return "an effect is missing, and these data cannot tell it from its rivals:";
  if (trace.verdict == TraceVerdict::not_identifiable)
    return "the form is there, but these data cannot tell what makes it:";
  return trace.rounds.empty()
             ? "structure is left that no effect of the catalogue explains: UNNAMED."
             : "structure is left that no effect of the catalogue explains: UNNAMED, beside:";
}

std::string round(const TraceRound& round, std::size_t index) {
  std::string text = item(
      std::to_string(index + 1) + ". " + round.accepted +
      (round.ambiguous_with.empty() ? "" : " or " + joined(round.ambiguous_with, " or ")) +
      ": residual " + residual_change(round) + ", difference in BIC " + number(round.delta_bic, 3) +
      ", p " + (round.p_value < 1e-4 ? "" : "= ") + probability(round.p_value));
  if (round.before_holdout_rms_um && round.after_holdout_rms_um)
    text += paragraph("     ",
                      "on profiles left out of the fit " +
                          change(*round.before_holdout_rms_um, *round.after_holdout_rms_um, " µm"));
  for (const FittedParameter& p : round.parameters)
    text += paragraph("     ", last_name(p.name) + " = " + value_of(p));
  return text;
}

/// How far the missing effects had bent the parameters, in units of their final uncertainty.
std::string bent(const Result& result) {
  TextTable table({"parameter", "before", "after", "shift / U"},
                  {Column::name, Column::number, Column::number, Column::number});
  bool any = false;
  for (const FittedParameter& before : result.declared->parameters) {
    const FittedParameter* after = result.final->find(before.name);
    if (!after || !before.value || !after->value || !after->expanded_uncertainty ||
        !(*after->expanded_uncertainty > 0.0))
      continue;
    any = true;
    const double shift = (*before.value - *after->value) / *after->expanded_uncertainty;
    table.add({before.name, number(*before.value, 4), number(*after->value, 4),
               number(std::round(1000.0 * shift) / 1000.0 + 0.0, 2)});  // no -0
  }
  return any ? item("What that had done to the declared parameters:") + table.text() : "";
}

std::string left_over(const Unnamed& left) {
  const std::string unit = left.rms_um ? " µm" : " µrad";
  const auto size = [&](const std::optional<double>& um, const std::optional<double>& urad) {
    return number(um.value_or(urad.value_or(NAN)), 3) + unit;
  };
  std::string text = "Left without a name: " + size(left.rms_um, left.rms_urad) + " rms, " +
                     size(left.pv_um, left.pv_urad) + " peak to valley on " + left.profile +
                     " (lack of fit p " + (left.p_value < 1e-4 ? "" : "= ") +
                     probability(left.p_value) + "), largest from " + number(left.from_mm, 4) +
                     " to " + number(left.to_mm, 4) + " mm";
  if (!left.clock.empty())
    text += "; most alike on the clock " + left.clock + ", correlation length " +
            number(left.correlation_length, 2) + " " + left.correlation_unit;
  if (left.dominant_period_mm)
    text += "; dominant period " + number(*left.dominant_period_mm, 3) + " mm";
  if (left.odd_share)
    text += "; " + number(100.0 * *left.odd_share, 2) + " % of it odd about the axis";
  return item(text + ". It is not counted as an improvement.");
}

std::string limits(const TraceResult& trace) {
  if (trace.detection_limits.empty()) return "";
  const auto extremes = [](const DetectionLimit& limit) -> std::string {
    if (limit.by_shape.empty()) return "";
    const auto by_size = [](const LimitAtShape& a, const LimitAtShape& b) {
      return a.value.value_or(HUGE_VAL) < b.value.value_or(HUGE_VAL);
    };
    const auto [least, most] =
        std::minmax_element(limit.by_shape.begin(), limit.by_shape.end(), by_size);
    return number(least->value.value_or(NAN), 2) + " to " + number(most->value.value_or(NAN), 2);
  };
  TextTable table({"effect", "found from", "other shapes", "at"},
                  {Column::effect, Column::number, Column::number, Column::name});
  for (const DetectionLimit& limit : trace.detection_limits)
    table.add({limit.effect, limit.value ? number(*limit.value, 2) + " " + limit.unit : "none",
               extremes(limit), limit.at});
  return item("Sizes found with 80 % probability:") + table.text();
}

/// One line for each thing that is needed.
std::string untestable(const TraceResult& trace) {
  std::vector<std::pair<std::string, std::vector<std::string>>> by_need;
  for (const auto& entry : trace.not_testable) {
    const auto found = std::find_if(by_need.begin(), by_need.end(),
                                    [&](const auto& known) { return known.first == entry.needs; });
    if (found == by_need.end())
      by_need.push_back({entry.needs, {entry.effect}});
    else
      found->second.push_back(entry.effect);
  }
  std::string text;
  for (const auto& [needs, effects] : by_need)
    text += note("Not testable: " + joined(effects) + "; needs " + needs + ".");
  return text;
}

}  // namespace

std::string trace_text(const Analysis& analysis) {
  const TraceResult& trace = *analysis.trace;
  std::string text = heading("Closed loop: " + verdict(trace));
  for (std::size_t i = 0; i < trace.rounds.size(); ++i) text += round(trace.rounds[i], i);
  if (!trace.rounds.empty() && analysis.result.final) text += bent(analysis.result);
  if (trace.unnamed) text += left_over(*trace.unnamed);
  for (const std::string& line : trace.advice) text += note(line);
  for (const std::string& line : trace.notes) text += note(line);
  for (const auto& [effect, same] : trace.not_separable)
    text += note(effect + " and " + same + " are one column here: not separable");
  for (const TriedEffect& effect : trace.refused)
    if (effect.refused && effect.delta_bic < -10.0)
      text += note(effect.effect + " was refused: " + *effect.refused);
  for (const LeftEffect& effect : trace.left)
    text += note(effect.effect + " has left the model: " + effect.reason);
  text += untestable(trace);
  return text + limits(trace);
}

}  // namespace slideway
