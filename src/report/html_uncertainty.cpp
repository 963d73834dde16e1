#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "html_parts.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/result_fields.hpp"
#include "text_parts.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostCorrelations = 20;  // correlations listed

/// A parameter a row, a source a column; every parameter has the same sources.
Html html_budget(const ModelResult& model) {
  if (model.budget.empty()) return {};
  const std::vector<BudgetLine>& sources = model.budget.front().lines;
  std::vector<std::pair<Html, HtmlColumn>> columns{{"parameter", HtmlColumn::text},
                                                   {"unit", HtmlColumn::text}};
  for (const BudgetLine& line : sources)
    columns.emplace_back(Html(line.source) + " " + small("(type " + Html(text_of(line.type)) + ")"),
                         HtmlColumn::number);
  columns.emplace_back("combined u", HtmlColumn::number);
  HtmlTable table("Uncertainty budget: contribution to u, and its share of u²", columns);
  for (const Budget& each : model.budget) {
    double total = 0.0;
    for (const BudgetLine& line : each.lines) total += std::pow(line.standard_uncertainty, 2);
    std::vector<Html> cells{each.parameter, html_unit(each.unit)};
    for (std::size_t i = 0; i < sources.size(); ++i) {
      const double u = i < each.lines.size() ? each.lines[i].standard_uncertainty : NAN;
      const double share = total > 0.0 ? 100.0 * u * u / total : 0.0;
      cells.push_back(html_number(u, 2) + element("br") +
                      small(html_number(std::round(10.0 * share) / 10.0, 3) + " %"));
    }
    cells.push_back(html_number(std::sqrt(total), 2));
    table.add(cells);
  }
  return table.html();
}

Html html_noise(const ModelResult& model) {
  HtmlTable table(
      "How the uncertainties were scaled: noise of one low-band value, correlation of the residual",
      {{"profile", HtmlColumn::text},
       {"standard uncertainty", HtmlColumn::text},
       {"correlated", HtmlColumn::text},
       {"standard deviation", HtmlColumn::number},
       {"correlation length, mm", HtmlColumn::number},
       {"effective values", HtmlColumn::number},
       {"Ljung-Box p", HtmlColumn::number}});
  for (const NoiseSummary& n : model.noise)
    table.add({n.profile, text_of(n.scaling), n.correlated ? "yes" : "no",
               html_size(n.standard_deviation_um, n.standard_deviation_urad),
               html_number(n.correlation_mm, 3), html_number(n.effective_observations, 3),
               html_probability(n.ljung_box_p)});
  return table.html();
}

Html correlations(const ModelResult& model) {
  std::vector<ParameterCorrelation> pairs = model.correlations;
  std::ranges::stable_sort(pairs, std::greater(), [](const ParameterCorrelation& pair) {
    return std::abs(std::get<2>(pair));
  });
  const std::size_t listed = std::min(kMostCorrelations, pairs.size());
  HtmlTable table("Correlation of the estimates, the " + std::to_string(listed) + " largest of " +
                      std::to_string(pairs.size()) + " above 0.1",
                  {{"parameter", HtmlColumn::text},
                   {"parameter", HtmlColumn::text},
                   {"ρ", HtmlColumn::number}});
  for (const auto& [a, b, coefficient] : std::span(pairs).first(listed))
    table.add({a, b, html_number(coefficient, 4)});
  return table.html();
}

Html covered(const Result& result) {
  const char* const change =
      has_face(result) ? "change of the workpiece between cutting and measuring, " : "";
  return element("p", {{"class", "hint"}},
                 "Covered: noise of the profiles, its correlation, and the priors of the problem "
                 "file. " +
                     bold("Not covered:") +
                     " calibration of the instrument (scale, datum, tip), temperature, clamping, " +
                     change +
                     "and whatever the model leaves out without a trace in the residual. Put these "
                     "into the combined uncertainty by hand (GUM 5; ISO/TR 230-9).");
}

Html levelling(const ModelResult& model) {
  HtmlTable table(
      "Levelling of the traces, found with the parameters",
      {{"trace", HtmlColumn::text}, {"value ± U", HtmlColumn::number}, {"unit", HtmlColumn::text}});
  for (const FittedParameter& p : model.nuisances)
    table.add({p.name, html_value(p), html_unit(p.unit)});
  return table.html();
}

Html held_out(const Crosscheck& checks) {
  HtmlTable table("Profiles held out: measured against predicted",
                  {{"profile", HtmlColumn::text},
                   {"chi-square per value", HtmlColumn::number},
                   {"p, sharpest of four tests", HtmlColumn::text},
                   {"largest difference", HtmlColumn::number},
                   {"at, mm", HtmlColumn::number},
                   {"verdict", HtmlColumn::text}});
  for (const HeldOutCheck& check : checks.held_out)
    table.add({check.profile, html_number(check.chi2, 3), html_probability(check.p_value),
               html_size(check.largest_um, check.largest_urad), html_number(check.at_mm),
               bold(text_of(check.verdict))});
  HtmlTable among("The same quantity from several profiles",
                  {{"what", HtmlColumn::text},
                   {"profiles", HtmlColumn::text},
                   {"each by itself", HtmlColumn::text},
                   {html_symbol("E_n"), HtmlColumn::number},
                   {"verdict", HtmlColumn::text}});
  for (const ProfileCheck& check : checks.profiles)
    among.add({check.what, who_of(check), each_alone(check), html_en(check.En),
               bold(text_of(check.verdict))});
  HtmlTable repeats("What repeats have in common and the model lacks",
                    {{"profiles", HtmlColumn::text},
                     {"F", HtmlColumn::number},
                     {"p", HtmlColumn::number},
                     {"verdict", HtmlColumn::text}});
  for (const PureErrorCheck& check : checks.repeats)
    repeats.add({joined(check.profiles, " and "), html_number(check.F, 3),
                 html_probability(check.p_value), bold(text_of(check.verdict))});
  return table.html() + among.html() + repeats.html();
}

}  // namespace

HtmlSection html_uncertainty(const Analysis& analysis) {
  const Result& result = analysis.result;
  if (!result.final) return {};
  const ModelResult& model = *result.final;
  std::vector<std::string> remarks = result.notes;
  remarks.insert(remarks.end(), model.notes.begin(), model.notes.end());
  for (std::string& each : remarks) each = with_titles(each);
  Html body = html_budget(model) + html_noise(model) + correlations(model) + levelling(model) +
              held_out(result.crosscheck) + covered(result);
  if (!remarks.empty()) body += element("h3", "Notes") + html_list(remarks);
  return {"uncertainty", "Uncertainty", body};
}

HtmlSection html_identifiability(const Analysis& analysis) {
  if (!analysis.result.final) return {};
  const ModelResult& model = *analysis.result.final;
  const Identifiability& what = model.identifiability;
  HtmlTable lost(
      "Directions in which no prediction changes",
      {{"combination", HtmlColumn::text}, {"what would determine it", HtmlColumn::text}});
  for (const UndeterminedDirection& direction : what.unidentifiable)
    lost.add({in_words(direction.combination, model), with_titles(direction.advice)});
  HtmlTable found("What the data determine instead", {{"combination", HtmlColumn::text},
                                                      {"value ± U", HtmlColumn::number},
                                                      {"unit", HtmlColumn::text}});
  for (const DeterminedCombination& sum : what.determined)
    found.add({in_words(sum.combination, model), html_value(sum), html_unit(sum.unit)});
  const std::string rank = std::to_string(what.rank) + " of " + std::to_string(what.parameters);
  return {"identifiability", "What cannot be determined",
          element("p", (lost.empty() ? "All parameters of the final model are determined: rank "
                                     : "The final model has rank ") +
                           rank + ", condition " + html_number(what.condition, 3) + ".") +
              lost.html() + found.html()};
}

}  // namespace slideway
