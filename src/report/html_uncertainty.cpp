#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "html_parts.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;
constexpr std::size_t kLargest = 20;  // correlations listed

std::string budget_heading(const Node& line) {
  return html_text(line["source"]) + " <small>(type " + html_text(line["type"]) + ")</small>";
}

/// A parameter a row, a source a column; every parameter has the same sources.
std::string budget(const Node& report) {
  if (!report.has("final")) return "";
  const std::vector<Node> budgets = report["final"]["uncertainty_budget"].entries();
  if (budgets.empty()) return "";
  const std::vector<Node> sources = budgets.front()["lines"].entries();
  std::vector<std::pair<std::string, Column>> columns{{"parameter", Column::text},
                                                      {"unit", Column::text}};
  for (const Node& line : sources) columns.emplace_back(budget_heading(line), Column::number);
  columns.emplace_back("combined u", Column::number);
  HtmlTable table("Uncertainty budget: contribution to u, and its share of u²", columns);
  for (const Node& each : budgets) {
    const std::vector<Node> lines = each["lines"].entries();
    if (lines.size() != sources.size()) each["lines"].fail("as many sources as the first has");
    double total = 0.0;
    for (const Node& line : lines) total += std::pow(line["standard_uncertainty"].number(), 2);
    std::vector<std::string> cells{html_text(each["parameter"]), html_unit(each)};
    for (const Node& line : lines) {
      const double u = line["standard_uncertainty"].number();
      const double share = total > 0.0 ? 100.0 * u * u / total : 0.0;
      cells.push_back(html_number(u, 2) + "<br><small>" +
                      html_number(std::round(10.0 * share) / 10.0, 3) + " %</small>");
    }
    cells.push_back(html_number(std::sqrt(total), 2));
    table.add(cells);
  }
  return table.html();
}

std::string noise(const Node& fit) {
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
  for (const Node& n : fit["noise"].entries())
    table.add({html_text(n["profile"]), html_text(n["scaling"]), html_cell(n["order"]),
               html_size(n, "standard_deviation"), html_cell(n["correlation_mm"], 3),
               html_cell(n["effective_observations"], 3),
               html_probability(n["ljung_box_p"].number())});
  return table.html();
}

std::string correlations(const Node& fit) {
  std::vector<ParameterCorrelation> pairs = fit["correlations"].list([](const Node& each) {
    const std::vector<Node> parts = each.entries();
    if (parts.size() != 3) each.fail("two names and a coefficient");
    return ParameterCorrelation(parts[0].text(), parts[1].text(), parts[2].number());
  });
  std::ranges::stable_sort(pairs, std::greater(), [](const ParameterCorrelation& pair) {
    return std::abs(std::get<2>(pair));
  });
  const std::size_t listed = std::min(kLargest, pairs.size());
  HtmlTable table(
      "Correlation of the estimates, the " + std::to_string(listed) + " largest of " +
          std::to_string(pairs.size()) + " above 0.1",
      {{"parameter", Column::text}, {"parameter", Column::text}, {"ρ", Column::number}});
  for (const auto& [a, b, coefficient] : std::span(pairs).first(listed))
    table.add({escaped(a), escaped(b), html_number(coefficient, 4)});
  return table.html();
}

std::string covered() {
  return "<p class=\"hint\">Covered: noise of the profiles, its correlation, and the priors of the "
         "problem file. <b>Not covered:</b> calibration of the instrument (scale, datum, tip), "
         "temperature, clamping, change of the workpiece between cutting and measuring, and "
         "whatever the model leaves out without a trace in the residual. Put these into the "
         "combined uncertainty by hand (GUM 5; ISO/TR 230-9).</p>\n";
}

std::string levelling(const Node& fit) {
  HtmlTable table("Levelling of the traces, found with the parameters",
                  {{"trace", Column::text}, {"value ± U", Column::number}, {"unit", Column::text}});
  for (const Node& p : fit["nuisances"].entries()) {
    const auto value = p["value"].number_or_null(), U = p["expanded_uncertainty"].number_or_null();
    if (value && U) table.add({html_text(p["name"]), html_pair(*value, *U), html_unit(p)});
  }
  return table.html();
}

std::string uncertainty(const Node& report) {
  std::string out = budget(report);
  if (report.has("final")) {
    const Node fit = report["final"];
    const std::string notes = html_list(html_texts(fit["notes"]));
    out += noise(fit) + correlations(fit) + levelling(fit) + covered() +
           (notes.empty() ? "" : "<h3>Notes of the fit</h3>\n" + notes);
  }
  return html_section("uncertainty", "Uncertainty", out);
}

// --- what cannot be determined -----------------------------------------------------------------

std::string in_words(const Node& combination) {
  std::string out;
  for (const auto& [name, value] : combination.named_numbers()) {
    out += out.empty() ? (value < 0.0 ? "−" : "") : (value < 0.0 ? " − " : " + ");
    const std::string size = html_number(std::abs(value), 3);
    out += (size == "1" ? "" : size + " ") + escaped(name);
  }
  return out;
}

std::string identifiability(const Node& report) {
  if (!report.has("final")) return "";
  const Node what = report["final"]["identifiability"];
  HtmlTable lost("Directions in which no prediction changes",
                 {{"combination", Column::text}, {"what would determine it", Column::text}});
  for (const Node& direction : what["unidentifiable"].entries())
    lost.add({in_words(direction["combination"]), html_text(direction["advice"])});
  HtmlTable found(
      "What the data determine instead",
      {{"combination", Column::text}, {"value ± U", Column::number}, {"unit", Column::text}});
  for (const Node& sum : what["determined"].entries())
    found.add({in_words(sum["combination"]),
               html_pair(sum["value"].number(), sum["expanded_uncertainty"].number()),
               html_unit(sum)});
  return html_section(
      "identifiability", "What cannot be determined",
      "<p>" +
          std::string(lost.empty() ? "All parameters of the final model are determined: rank "
                                   : "The final model has rank ") +
          html_text(what["rank"]) + " of " + html_text(what["parameters"]) + ", condition " +
          html_number(what["condition"].number(), 3) + ".</p>\n" + lost.html() + found.html());
}

}  // namespace

std::string html_uncertainty(const Node& report) {
  return uncertainty(report) + identifiability(report);
}

}  // namespace slideway
