#include <algorithm>

#include "html_parts.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

std::string arrow(const Json& round, const std::string& before, const std::string& after) {
  for (const char* unit : {"um", "urad"}) {
    const auto from = number_of(round, (before + unit).c_str());
    const auto to = number_of(round, (after + unit).c_str());
    if (from && to)
      return html_number(*from, 3) + " → " + html_number(*to, 3) + " " + html_unit(unit);
  }
  return "–";
}

std::string values(const Json& parameters) {
  std::string out;
  for (const Json& p : parameters) {
    const auto value = number_of(p, "value"), U = number_of(p, "expanded_uncertainty");
    if (!value) continue;
    const std::string name = p.at("name").get<std::string>();
    const std::string unit = html_unit(p.at("unit").get<std::string>());
    out += (out.empty() ? "" : "<br>") + escaped(name.substr(name.rfind('.') + 1)) + " = " +
           (U ? html_pair(*value, *U) : html_number(*value, 4)) + (unit.empty() ? "" : " " + unit);
  }
  return out;
}

std::string accepted(const Json& trace) {
  HtmlTable table("Effects that entered the model",
                  {{"effect", Column::text},
                   {"parameters ± U", Column::text},
                   {"residual rms", Column::number},
                   {"on profiles left out of the fit", Column::number},
                   {"ΔBIC", Column::number},
                   {"p", Column::number},
                   {"not told apart from", Column::text}});
  for (const Json& round : list_of(trace, "rounds")) {
    std::string rivals;
    for (const Json& rival : list_of(round, "ambiguous_with"))
      rivals += (rivals.empty() ? "" : ", ") + escaped(rival.get<std::string>());
    table.add({text_of(round, "accepted"), values(list_of(round, "parameters")),
               arrow(round, "before_rms_", "after_rms_"),
               arrow(round, "before_holdout_rms_", "after_holdout_rms_"),
               html_cell(round, "delta_bic", 3),
               html_probability(round.at("p_value").get<double>()), rivals.empty() ? "–" : rivals});
  }
  return table.html();
}

std::string tried(const Json& trace) {
  HtmlTable table("Effects tried", {{"effect", Column::text},
                                    {"in round", Column::text},
                                    {"ΔBIC", Column::number},
                                    {"p", Column::number},
                                    {"residual rms, µm", Column::number},
                                    {"why it is not in the model", Column::text}});
  const auto add = [&](const Json& effect, const std::string& round) {
    table.add(
        {text_of(effect, "effect"), round, html_cell(effect, "delta_bic"),
         html_probability(effect.at("p_value").get<double>()), html_cell(effect, "rms_um"),
         has(effect, "refused") ? text_of(effect, "refused") : "a rival of the accepted one"});
  };
  std::size_t index = 0;
  for (const Json& round : list_of(trace, "rounds")) {
    ++index;
    for (const Json& effect : list_of(round, "candidates")) add(effect, std::to_string(index));
  }
  for (const Json& effect : list_of(trace, "refused")) add(effect, "last");
  return table.html();
}

std::string extremes(const Json& limit) {
  const Json& shapes = list_of(limit, "by_shape");
  if (shapes.empty()) return "";
  const auto [least, most] =
      std::minmax_element(shapes.begin(), shapes.end(), [](const Json& a, const Json& b) {
        return a.at("value").get<double>() < b.at("value").get<double>();
      });
  return html_cell(*least, "value", 2) + " to " + html_cell(*most, "value", 2);
}

std::string untried(const Json& trace) {
  HtmlTable table("Effects not told apart or not testable with these data",
                  {{"effect", Column::text}, {"why", Column::text}});
  for (const Json& each : list_of(trace, "not_separable"))
    table.add({text_of(each, "effect"), "one column with " + text_of(each, "same_as")});
  for (const Json& each : list_of(trace, "not_testable"))
    table.add({text_of(each, "effect"), "needs " + text_of(each, "needs")});
  HtmlTable limits("Size an effect must have to be found with 80 % probability",
                   {{"effect", Column::text},
                    {"parameter", Column::text},
                    {"found from", Column::number},
                    {"unit", Column::text},
                    {"at", Column::text},
                    {"at other shapes", Column::text}});
  for (const Json& limit : list_of(trace, "detection_limits"))
    limits.add({text_of(limit, "effect"), text_of(limit, "parameter"), html_cell(limit, "value", 2),
                html_unit(limit.at("unit").get<std::string>()), text_of(limit, "at"),
                extremes(limit)});
  return table.html() + limits.html();
}

std::string unnamed(const Json& trace) {
  if (!has(trace, "unnamed")) return "";
  const Json& left = trace.at("unnamed");
  std::string out = "<p>Left without a name: " + html_size(left, "rms") + " rms, " +
                    html_size(left, "pv") + " peak to valley on <b>" + text_of(left, "profile") +
                    "</b> (lack of fit " + html_p_value(left.at("p_value").get<double>()) +
                    "), largest from " + html_cell(left, "from_mm", 4) + " to " +
                    html_cell(left, "to_mm", 4) + " mm";
  if (has(left, "clock") && !left.at("clock").get_ref<const std::string&>().empty())
    out += "; most alike on the clock " + text_of(left, "clock") + ", correlation length " +
           html_cell(left, "correlation_length", 2) + " " +
           html_unit(left.at("correlation_unit").get<std::string>());
  if (has(left, "dominant_period_mm"))
    out += "; dominant period " + html_cell(left, "dominant_period_mm") + " mm";
  if (const auto odd = number_of(left, "odd_share"))
    out += "; " + html_number(100.0 * *odd, 2) + " % of it odd about the axis";
  return out + ". It is not counted as an improvement.</p>\n";
}

}  // namespace

std::string html_loop_tables(const Json& report) {
  if (!has(report, "trace")) return "";
  const Json& trace = report.at("trace");
  std::vector<std::string> notes;
  for (const Json& note : list_of(trace, "notes"))
    notes.push_back(escaped(note.get<std::string>()));
  return html_section(
      "loop", "Missing effects: found, tried, refused",
      unnamed(trace) + accepted(trace) + html_list(notes) + tried(trace) + untried(trace));
}

}  // namespace slideway
