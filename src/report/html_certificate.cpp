#include <cmath>

#include "html_parts.hpp"
#include "slideway/base/units.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/result_fields.hpp"

/// What a person signs: who measured what with which instrument, the results with their
/// uncertainty, and the rule by which they are held against a tolerance.
namespace slideway {
namespace {

/// Keys of [about] in the order of a certificate, for people; a blank is filled in by hand.
constexpr std::pair<const char*, const char*> kAbout[] = {
    {"customer", "Customer"},
    {"laboratory", "Laboratory"},
    {"certificate", "Certificate number"},
    {"machine", "Machine"},
    {"manufacturer", "Manufacturer of the machine"},
    {"serial", "Serial number of the machine"},
    {"workpiece", "Workpiece, clamping, tool"},
    {"instrument", "Instrument"},
    {"instrument_serial", "Serial number of the instrument"},
    {"calibrated", "Instrument calibrated"},
    {"conditions", "Conditions: temperature, warm-up, compensation active"},
    {"place", "Place"},
    {"country", "Country"},
    {"date", "Measured on"},
    {"operator", "Measured by"},
    {"responsible", "Responsible"},
    {"remark", "Remark"},
    {"evaluated", "Evaluated on"}};

Html head(const Result& result) {
  Html rows;
  const auto add = [&](const Html& name, const Html& value) {
    rows += element("tr", element("th", {{"scope", "row"}}, name) + element("td", value));
  };
  for (const auto& [key, name] : kAbout) {
    const auto given = result.about.find(key);
    if (given != result.about.end())
      add(name, given->second);
    else if (std::string_view(key) != "remark" &&
             (std::string_view(key) != "workpiece" || has_face(result)))
      add(name, "");
  }
  add("Evaluated by", "slideway " + result.version);
  return html_scroll(
      element("table", {{"class", "fill"}},
              element("caption", "Object, instrument and conditions") + element("tbody", rows)));
}

Html results(const ModelResult& model) {
  HtmlTable table("Results, expanded uncertainty U = k u, coverage 95.45 %",
                  {{"quantity", HtmlColumn::text},
                   {"value ± U", HtmlColumn::number},
                   {"unit", HtmlColumn::text},
                   {"k", HtmlColumn::number},
                   {"u", HtmlColumn::number}});
  if (model.straightness)
    for (const StraightnessError& error : model.straightness->errors)
      table.add({"Straightness " + html_symbol("E_ZX") + ", " + Html(text_of(error.line)) + " line",
                 html_value(error), "µm", html_number(error.coverage_factor, 3),
                 html_number(error.standard_uncertainty, 2)});
  for (const FittedParameter& p : model.parameters) {
    if (!is_squareness(p)) continue;
    const std::optional<double> u = p.standard_uncertainty
                                        ? std::optional(*p.standard_uncertainty / kMicroradian)
                                        : std::nullopt;
    table.add({"Squareness " + html_symbol(p.symbol), html_value(p, kMicroradian), "µm/m",
               html_number(p.coverage_factor, 3), html_number(u, 2)});
  }
  return table.html();
}

/// The sources of a carriage's error one by one, GUM 8.2.
Html budget_rows(const ModelResult& model) {
  HtmlTable table("Uncertainty budget of the carriages' errors",
                  {{"quantity and source", HtmlColumn::text},
                   {"type", HtmlColumn::text},
                   {"u", HtmlColumn::number},
                   {"share of u²", HtmlColumn::number},
                   {"unit", HtmlColumn::text}});
  for (const Budget& each : model.budget) {
    if (motion_error_of(each.parameter) == MotionError::none) continue;
    double total = 0.0;
    for (const BudgetLine& line : each.lines) total += std::pow(line.standard_uncertainty, 2);
    for (const BudgetLine& line : each.lines) {
      const double share =
          total > 0.0 ? 100.0 * std::pow(line.standard_uncertainty, 2) / total : 0.0;
      table.add({Html(each.parameter) + ": " + line.source, text_of(line.type),
                 html_number(line.standard_uncertainty, 2),
                 html_number(std::round(share), 3) + " %", html_unit(each.unit)});
    }
    table.add({Html(each.parameter) + ": combined", "", html_number(std::sqrt(total), 2), "",
               html_unit(each.unit)});
  }
  return table.html();
}

Html rule(const Result& result) {
  if (result.conformity.empty())
    return element("p", "No tolerance is given, so no conformity is stated.");
  return element("p",
                 "Decision rule: ISO 14253-1, U as guard band. What lies within its limit by "
                 "more than U conforms, what lies beyond it by more than U does not; between "
                 "the two it cannot be decided.");
}

Html to_sign() {
  Html cells;
  for (const char* what : {"Place, date", "Name", "Signature"})
    cells += element("tr", element("th", {{"scope", "row"}}, what) + element("td"));
  return html_scroll(element("table", {{"class", "sign"}},
                             element("caption", "Signed") + element("tbody", cells)));
}

}  // namespace

HtmlSection html_certificate(const Analysis& analysis) {
  const Result& result = analysis.result;
  if (!result.final) return {};
  return {
      "certificate", "For the signature",
      head(result) + results(*result.final) + html_conformity(result) + rule(result) + to_sign() +
          budget_rows(*result.final) +
          element("p", {{"class", "hint"}},
                  "Type A: from the scatter of the profiles. Type B: from what the problem file "
                  "states. Calibration of the instrument, temperature and clamping are covered "
                  "only where the problem file states them.")};
}

}  // namespace slideway
