#include <algorithm>

#include "html_parts.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

std::string values(const Node& parameters) {
  std::vector<std::string> lines;
  for (const Node& p : parameters.entries()) {
    const auto value = p["value"].number_or_null(), U = p["expanded_uncertainty"].number_or_null();
    if (!value) continue;
    const std::string& name = p["name"].verbatim();
    const std::string unit = html_unit(p);
    lines.push_back(escaped(name.substr(name.rfind('.') + 1)) + " = " +
                    (U ? html_pair(*value, *U) : html_number(*value, 4)) +
                    (unit.empty() ? "" : " " + unit));
  }
  return joined(lines, "<br>");
}

std::string or_dash(const std::string& text) { return text.empty() ? "–" : text; }

std::string accepted(const Node& trace) {
  HtmlTable table("Effects that entered the model",
                  {{"effect", Column::text},
                   {"parameters ± U", Column::text},
                   {"residual rms", Column::number},
                   {"on profiles left out of the fit", Column::number},
                   {"ΔBIC", Column::number},
                   {"p", Column::number},
                   {"not told apart from", Column::text}});
  for (const Node& round : trace["rounds"].entries())
    table.add({html_text(round["accepted"]), values(round["parameters"]),
               or_dash(html_change(round, "before_rms", round, "after_rms")),
               or_dash(html_change(round, "before_holdout_rms", round, "after_holdout_rms")),
               html_cell(round["delta_bic"], 3), html_probability(round["p_value"].number()),
               or_dash(joined(html_texts(round["ambiguous_with"])))});
  return table.html();
}

std::string tried(const Node& trace) {
  HtmlTable table("Effects tried", {{"effect", Column::text},
                                    {"in round", Column::text},
                                    {"ΔBIC", Column::number},
                                    {"p", Column::number},
                                    {"residual rms, µm", Column::number},
                                    {"why it is not in the model", Column::text}});
  const auto add = [&](const Node& effect, const std::string& round) {
    table.add(
        {html_text(effect["effect"]), round, html_cell(effect["delta_bic"]),
         html_probability(effect["p_value"].number()), html_cell(effect["rms_um"]),
         effect.has("refused") ? html_text(effect["refused"]) : "a rival of the accepted one"});
  };
  std::size_t index = 0;
  for (const Node& round : trace["rounds"].entries()) {
    ++index;
    for (const Node& effect : round["candidates"].entries()) add(effect, std::to_string(index));
  }
  for (const Node& effect : trace["refused"].entries()) add(effect, "last");
  return table.html();
}

std::string extremes(const Node& limit) {
  const std::vector<Node> shapes = limit["by_shape"].entries();
  if (shapes.empty()) return "";
  const auto [least, most] = std::ranges::minmax_element(
      shapes, {}, [](const Node& shape) { return shape["value"].number(); });
  return html_cell((*least)["value"], 2) + " to " + html_cell((*most)["value"], 2);
}

std::string untried(const Node& trace) {
  HtmlTable table("Effects not told apart or not testable with these data",
                  {{"effect", Column::text}, {"why", Column::text}});
  for (const Node& each : trace["not_separable"].entries())
    table.add({html_text(each["effect"]), "one column with " + html_text(each["same_as"])});
  for (const Node& each : trace["not_testable"].entries())
    table.add({html_text(each["effect"]), "needs " + html_text(each["needs"])});
  HtmlTable limits("Size an effect must have to be found with 80 % probability",
                   {{"effect", Column::text},
                    {"parameter", Column::text},
                    {"found from", Column::number},
                    {"unit", Column::text},
                    {"at", Column::text},
                    {"at other shapes", Column::text}});
  for (const Node& limit : trace["detection_limits"].entries())
    limits.add({html_text(limit["effect"]), html_text(limit["parameter"]),
                html_cell(limit["value"], 2), html_unit(limit), html_text(limit["at"]),
                extremes(limit)});
  return table.html() + limits.html();
}

std::string unnamed(const Node& trace) {
  if (!trace.has("unnamed")) return "";
  const Node left = trace["unnamed"];
  std::string out = "<p>Left without a name: " + html_size(left, "rms") + " rms, " +
                    html_size(left, "pv") + " peak to valley on <b>" + html_text(left["profile"]) +
                    "</b> (lack of fit " + html_p_value(left["p_value"].number()) +
                    "), largest from " + html_cell(left["from_mm"], 4) + " to " +
                    html_cell(left["to_mm"], 4) + " mm";
  if (left.has("clock") && !left["clock"].verbatim().empty())
    out += "; most alike on the clock " + html_text(left["clock"]) + ", correlation length " +
           html_cell(left["correlation_length"], 2) + " " +
           html_unit(left["correlation_unit"].verbatim());
  if (left.has("dominant_period_mm"))
    out += "; dominant period " + html_cell(left["dominant_period_mm"]) + " mm";
  if (const auto odd = left["odd_share"].number_or_null())
    out += "; " + html_number(100.0 * *odd, 2) + " % of it odd about the axis";
  return out + ". It is not counted as an improvement.</p>\n";
}

}  // namespace

std::string html_loop(const Node& report) {
  if (!report.has("trace")) return "";
  const Node trace = report["trace"];
  return html_section("loop", "Missing effects: found, tried, refused",
                      unnamed(trace) + accepted(trace) + html_list(html_texts(trace["notes"])) +
                          tried(trace) + untried(trace));
}

}  // namespace slideway
