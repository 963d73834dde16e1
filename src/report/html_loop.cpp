#include <algorithm>

#include "html_parts.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

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
                  {{"effect", Column::text},
                   {"parameters ± U", Column::text},
                   {"residual rms", Column::number},
                   {"on profiles left out of the fit", Column::number},
                   {"ΔBIC", Column::number},
                   {"p", Column::number},
                   {"chosen by", Column::number},
                   {"not told apart from", Column::text}});
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
  HtmlTable table("Effects tried", {{"effect", Column::text},
                                    {"in round", Column::text},
                                    {"ΔBIC", Column::number},
                                    {"p", Column::number},
                                    {"residual rms, µm", Column::number},
                                    {"why it is not in the model", Column::text}});
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
                  {{"effect", Column::text}, {"why", Column::text}});
  for (const LeftEffect& each : trace.left)
    table.add({effect_title(each.effect), "left: " + with_titles(each.reason)});
  for (const NotSeparable& each : trace.not_separable)
    table.add({effect_title(each.effect), "one column with " + with_titles(each.same_as)});
  for (const NotTestable& each : trace.not_testable)
    table.add({effect_title(each.effect), "needs " + each.needs});
  return table.html();
}

Html extremes(const DetectionLimit& limit) {
  std::vector<double> sizes;
  for (const LimitAtShape& each : limit.by_shape)
    if (each.value) sizes.push_back(*each.value);
  if (sizes.empty()) return {};
  const auto [least, most] = std::ranges::minmax(sizes);
  return html_number(least, 2) + " to " + html_number(most, 2);
}

Html limits(const TraceResult& trace) {
  HtmlTable table("Size an effect must have to be found with 80 % probability",
                  {{"effect", Column::text},
                   {"parameter", Column::text},
                   {"found from", Column::number},
                   {"unit", Column::text},
                   {"at", Column::text},
                   {"at other shapes", Column::text}});
  for (const DetectionLimit& limit : trace.detection_limits)
    table.add({effect_title(limit.effect), limit.parameter,
               limit.value ? html_number(limit.value, 2) : "at no size", html_unit(limit.unit),
               limit.at, extremes(limit)});
  return table.html();
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
  return element("p", out + ". It is not counted as an improvement.");
}

}  // namespace

HtmlSection html_loop(const Analysis& analysis) {
  if (!analysis.trace) return {};
  const TraceResult& trace = *analysis.trace;
  std::vector<std::string> remarks;
  for (const std::string& note : trace.notes) remarks.push_back(with_titles(note));
  return {"loop", "Missing effects: found, tried, refused",
          unnamed(trace) + accepted(trace) + html_list(remarks) + tried(trace) + untried(trace) +
              limits(trace)};
}

}  // namespace slideway
