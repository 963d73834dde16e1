#include <algorithm>
#include <cmath>

#include "html_parts.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;
constexpr std::size_t kLargest = 20;  // correlations listed

std::string plain(const std::string& text) { return text.empty() ? "" : "<p>" + text + "</p>\n"; }

std::string notes(const Json& owner, const char* key, const std::string& title) {
  std::vector<std::string> items;
  for (const Json& note : list_of(owner, key)) items.push_back(escaped(note.get<std::string>()));
  return items.empty() ? "" : "<h3>" + title + "</h3>\n" + html_list(items);
}

std::string budget_heading(const Json& line) {
  return text_of(line, "source") + " <small>(type " + text_of(line, "type") + ")</small>";
}

/// A parameter a row, a source a column; every parameter has the same sources.
std::string budget(const Json& report) {
  const Json& budgets = list_of(report, "uncertainty_budget");
  if (budgets.empty()) return "";
  const Json& sources = list_of(budgets.front(), "lines");
  std::vector<std::pair<std::string, Column>> columns{{"parameter", Column::text},
                                                      {"unit", Column::text}};
  for (const Json& line : sources) columns.emplace_back(budget_heading(line), Column::number);
  columns.emplace_back("combined u", Column::number);
  HtmlTable table("Uncertainty budget: contribution to u, and its share of u²", columns);
  for (const Json& each : budgets) {
    const Json& lines = list_of(each, "lines");
    if (lines.size() != sources.size())
      throw DataError("the parameters of 'uncertainty_budget' differ in their sources");
    double total = 0.0;
    for (const Json& line : lines)
      total += std::pow(line.at("standard_uncertainty").get<double>(), 2);
    std::vector<std::string> cells{text_of(each, "parameter"),
                                   html_unit(each.at("unit").get<std::string>())};
    for (const Json& line : lines) {
      const double u = line.at("standard_uncertainty").get<double>();
      const double share = total > 0.0 ? 100.0 * u * u / total : 0.0;
      cells.push_back(html_number(u, 2) + "<br><small>" +
                      html_number(std::round(10.0 * share) / 10.0, 3) + " %</small>");
    }
    cells.push_back(html_number(std::sqrt(total), 2));
    table.add(cells);
  }
  return table.html();
}

std::string noise(const Json& fit) {
  HtmlTable table(
      "How the uncertainties were scaled: noise of one low-band value, AR(p) "
      "correlation of the residual",
      {{"profile", Column::text},
       {"standard uncertainty", Column::text},
       {"p", Column::number},
       {"standard deviation", Column::number},
       {"correlation length, mm", Column::number},
       {"effective values", Column::number},
       {"Ljung-Box p", Column::number}});
  for (const Json& n : list_of(fit, "noise"))
    table.add({text_of(n, "profile"), text_of(n, "scaling"), html_cell(n, "order"),
               html_size(n, "standard_deviation"), html_cell(n, "correlation_mm", 3),
               html_cell(n, "effective_observations", 3),
               html_probability(n.at("ljung_box_p").get<double>())});
  return table.html();
}

std::string correlations(const Json& fit) {
  std::vector<Json> pairs = list_of(fit, "correlations").get<std::vector<Json>>();
  const auto size = [](const Json& pair) { return std::abs(pair.at(2).get<double>()); };
  std::stable_sort(pairs.begin(), pairs.end(),
                   [&](const Json& a, const Json& b) { return size(a) > size(b); });
  HtmlTable table(
      "Correlation of the estimates (declared model), the " +
          std::to_string(std::min(kLargest, pairs.size())) + " largest of " +
          std::to_string(pairs.size()) + " above 0.1",
      {{"parameter", Column::text}, {"parameter", Column::text}, {"ρ", Column::number}});
  for (std::size_t i = 0; i < std::min(kLargest, pairs.size()); ++i)
    table.add({escaped(pairs[i].at(0).get<std::string>()),
               escaped(pairs[i].at(1).get<std::string>()),
               html_number(pairs[i].at(2).get<double>(), 4)});
  return table.html();
}

std::string covered() {
  return "<p class=\"hint\">Covered: noise of the profiles, its correlation, and the priors of the "
         "problem file. <b>Not covered:</b> calibration of the instrument (scale, datum, tip), "
         "temperature, clamping, change of the workpiece between cutting and measuring, and "
         "whatever the model leaves out without a trace in the residual. Put these into the "
         "combined uncertainty by hand (GUM 5; ISO/TR 230-9).</p>\n";
}

std::string uncertainty(const Json& report) {
  std::string out = budget(report);
  if (has(report, "fit")) {
    const Json& fit = report.at("fit");
    out += noise(fit) + correlations(fit);
    HtmlTable levelling(
        "Levelling of the traces, found with the parameters",
        {{"trace", Column::text}, {"value ± U", Column::number}, {"unit", Column::text}});
    for (const Json& p : list_of(fit, "nuisances")) {
      const auto value = number_of(p, "value"), U = number_of(p, "expanded_uncertainty");
      if (value && U)
        levelling.add({text_of(p, "name"), html_pair(*value, *U),
                       html_unit(p.at("unit").get<std::string>())});
    }
    out += levelling.html() + covered() + notes(fit, "notes", "Notes of the fit");
  }
  return html_section("uncertainty", "Uncertainty", out);
}

// --- what can not be determined -----------------------------------------------------------------

std::string in_words(const Json& combination) {
  std::string out;
  for (const auto& [name, factor] : combination.items()) {
    const double value = factor.get<double>();
    out += out.empty() ? (value < 0.0 ? "−" : "") : (value < 0.0 ? " − " : " + ");
    const std::string size = html_number(std::abs(value), 3);
    out += (size == "1" ? "" : size + " ") + escaped(name);
  }
  return out;
}

std::string identifiability(const Json& report) {
  if (!has(report, "fit")) return "";
  const Json& what = report.at("fit").at("identifiability");
  HtmlTable lost("Directions in which no prediction changes",
                 {{"combination", Column::text}, {"what would determine it", Column::text}});
  for (const Json& direction : list_of(what, "unidentifiable"))
    lost.add({in_words(direction.at("combination")), text_of(direction, "advice")});
  HtmlTable found(
      "What the data determine instead",
      {{"combination", Column::text}, {"value ± U", Column::number}, {"unit", Column::text}});
  for (const Json& sum : list_of(what, "determined"))
    found.add(
        {in_words(sum.at("combination")),
         html_pair(sum.at("value").get<double>(), sum.at("expanded_uncertainty").get<double>()),
         html_unit(sum.at("unit").get<std::string>())});
  return html_section(
      "identifiability", "What can not be determined",
      plain((lost.empty() ? "All parameters of the declared model are determined: rank "
                          : "The declared model has rank ") +
            text_of(what, "rank") + " of " + text_of(what, "parameters") + ", condition " +
            html_number(what.at("condition").get<double>(), 3) + ".") +
          lost.html() + found.html());
}

}  // namespace

std::string html_uncertainty(const Json& report) {
  return uncertainty(report) + identifiability(report);
}

}  // namespace slideway
