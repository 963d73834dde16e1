#include <algorithm>

#include "html_parts.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

Html values(const std::vector<FittedParameter>& parameters) {
  std::vector<Html> lines;
  for (const FittedParameter& p : parameters)
    lines.push_back(Html(p.name.substr(p.name.rfind('.') + 1)) + " = " + html_value(p) + " " +
                    html_unit(p.unit));
  return joined(lines, element("br"));
}

Html or_dash(const Html& text) { return text.empty() ? "–" : text; }

Html change(const std::optional<double>& before_um, const std::optional<double>& after_um,
            const std::optional<double>& before_urad = {},
            const std::optional<double>& after_urad = {}) {
  return or_dash(residual_change(before_um, after_um, before_urad, after_urad));
}

Html accepted(const TraceResult& trace) {
  HtmlTable table("Effects that entered the model",
                  {{"effect", HtmlColumn::text},
                   {"parameters ± U", HtmlColumn::text},
                   {"residual rms", HtmlColumn::number},
                   {"on profiles left out of the fit", HtmlColumn::number},
                   {"ΔBIC", HtmlColumn::number},
                   {"p", HtmlColumn::number},
                   {"chosen by", HtmlColumn::number},
                   {"not told apart from", HtmlColumn::text}});
  for (const TraceRound& round : trace.rounds)
    table.add({effect_title(names_of(round).front()), values(round.parameters),
               change(round.before_rms_um, round.after_rms_um, round.before_rms_urad,
                      round.after_rms_urad),
               change(round.before_holdout_rms_um, round.after_holdout_rms_um),
               html_number(round.delta_bic, 3), html_probability(round.p_value),
               html_number(100.0 * round.stability, 2) + " %",
               or_dash(effect_titles(round.ambiguous_with, ", "))});
  return table.html();
}

Html tried(const TraceResult& trace) {
  HtmlTable table("Effects tried", {{"effect", HtmlColumn::text},
                                    {"in round", HtmlColumn::text},
                                    {"ΔBIC", HtmlColumn::number},
                                    {"p", HtmlColumn::number},
                                    {"residual rms, µm", HtmlColumn::number},
                                    {"why it is not in the model", HtmlColumn::text}});
  const auto add = [&](const TriedEffect& effect, const std::string& round) {
    table.add({effect_title(term_name(effect.effect, effect.profiles)), round,
               html_number(effect.delta_bic), html_probability(effect.p_value),
               html_number(effect.rms_um),
               with_titles(effect.refused.value_or("a rival of the accepted one"))});
  };
  for (std::size_t i = 0; i < trace.rounds.size(); ++i)
    for (const TriedEffect& effect : trace.rounds[i].candidates) add(effect, std::to_string(i + 1));
  for (const TriedEffect& effect : trace.refused) add(effect, "last");
  return table.html();
}

Html untried(const TraceResult& trace) {
  HtmlTable table("Effects that left again, are not told apart or not testable with these data",
                  {{"effect", HtmlColumn::text}, {"why", HtmlColumn::text}});
  for (const LeftEffect& each : trace.left)
    table.add({effect_title(each.effect), "left: " + with_titles(each.reason)});
  for (const NotSeparable& each : trace.not_separable)
    table.add({effect_title(each.effect), "one column with " + with_titles(each.same_as)});
  for (const NotTestable& each : trace.not_testable)
    table.add({effect_title(each.effect), "needs " + each.needs});
  return table.html();
}

Html html_extremes(const DetectionLimit& limit) {
  std::vector<double> sizes;
  for (const LimitAtShape& each : limit.by_shape)
    if (each.value) sizes.push_back(*each.value);
  if (sizes.empty()) return {};
  const auto [least, most] = std::ranges::minmax(sizes);
  return html_number(least, 2) + " to " + html_number(most, 2);
}

Html html_limits(const TraceResult& trace) {
  HtmlTable table("Size an effect must have to be found with 80 % probability",
                  {{"effect", HtmlColumn::text},
                   {"parameter", HtmlColumn::text},
                   {"found from", HtmlColumn::number},
                   {"unit", HtmlColumn::text},
                   {"at", HtmlColumn::text},
                   {"at other shapes", HtmlColumn::text},
                   {"moves Δβxz unseen, µm/m", HtmlColumn::number},
                   {"moves E_ZX unseen, µm", HtmlColumn::number}});
  for (const DetectionLimit& limit : trace.detection_limits)
    table.add({effect_title(limit.effect), limit.parameter,
               limit.value ? html_number(limit.value, 2) : "at no size", html_unit(limit.unit),
               limit.at, html_extremes(limit),
               limit.squareness_rad ? html_number(*limit.squareness_rad / kMicroradian, 2) : Html(),
               html_number(limit.straightness_um, 2)});
  return table.html();
}

/// What describes the rest, each with a block to paste.
Html html_forms(const Unnamed& left) {
  if (left.forms.empty()) return {};
  HtmlTable table("Short formulas that describe what is left: no causes",
                  {{"form", HtmlColumn::text},
                   {"formula", HtmlColumn::text},
                   {"parameters ± U", HtmlColumn::text},
                   {"residual rms", HtmlColumn::number},
                   {"on profiles left out of the fit", HtmlColumn::number},
                   {"ΔBIC", HtmlColumn::number}});
  Html blocks;
  for (const UnnamedForm& form : left.forms) {
    Html formula = element("code", form.formula);
    if (!form.profiles.empty()) formula += " in " + Html(joined(form.profiles));
    if (!form.instead_of.empty()) formula += " in place of " + Html(effect_title(form.instead_of));
    table.add(
        {form.form, formula, values(form.parameters),
         change(form.before_rms_um, form.after_rms_um, form.before_rms_urad, form.after_rms_urad),
         change(form.before_holdout_rms_um, form.after_holdout_rms_um),
         html_number(form.delta_bic, 3)});
    blocks += element("details",
                      element("summary", "To look for it in the next run: " + Html(form.form)) +
                          element("pre", form.candidate));
  }
  return table.html() +
         element("p", "To confirm one before it is taken for a cause: " +
                          Html(with_titles(left.to_confirm)) + ".") +
         blocks;
}

Html unnamed(const TraceResult& trace) {
  if (!trace.unnamed) return {};
  const Unnamed& left = *trace.unnamed;
  Html out = "Left without a name: " + html_size(left.rms_um, left.rms_urad) + " rms, " +
             html_size(left.pv_um, left.pv_urad) + " peak to valley on " + bold(left.profile) +
             " (lack of fit " + html_p_value(left.p_value) + "), largest from " +
             html_number(left.from_mm) + " to " + html_number(left.to_mm) + " mm";
  if (!left.clock.empty())
    out += "; best described as " + Html(likeness(left)) + ", correlation length " +
           html_number(left.correlation_length, 2) + " " + html_unit(left.correlation_unit);
  if (left.dominant_period_mm)
    out += "; dominant period " + html_number(left.dominant_period_mm) + " mm";
  if (left.odd_share)
    out += "; " + html_number(100.0 * *left.odd_share, 2) + " % of it odd about the axis";
  return element("p", out + ". It is not counted as an improvement.") + html_forms(left);
}

}  // namespace

HtmlSection html_loop(const Analysis& analysis) {
  if (!analysis.trace) return {};
  const TraceResult& trace = *analysis.trace;
  std::vector<std::string> remarks;
  for (const std::string& note : trace.notes) remarks.push_back(with_titles(note));
  if (!trace.not_looked_at.empty())
    remarks.push_back("Not looked at within the time limit: " + joined(trace.not_looked_at) + ".");
  return {"loop", "Missing effects: found, tried, refused",
          unnamed(trace) + accepted(trace) + html_list(remarks) + tried(trace) + untried(trace) +
              html_limits(trace)};
}

}  // namespace slideway
