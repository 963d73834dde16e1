#include <algorithm>
#include <cmath>
#include <map>

#include "html_parts.hpp"
#include "slideway/base/error.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;
constexpr std::size_t kLargest = 20;  // correlations listed

std::string number_cell(const Json& object, const char* key, int digits = 4) {
  const auto value = number_of(object, key);
  return value ? html_number(*value, digits) : "–";
}

std::string plain(const std::string& text) { return text.empty() ? "" : "<p>" + text + "</p>\n"; }

std::string notes(const Json& owner, const char* key, const std::string& title) {
  std::vector<std::string> items;
  for (const Json& note : list_of(owner, key)) items.push_back(escaped(note.get<std::string>()));
  return items.empty() ? "" : "<h3>" + title + "</h3>\n" + html_list(items);
}

// --- uncertainty --------------------------------------------------------------------------------

std::string budget(const Json& report) {
  HtmlTable table("Uncertainty budget: squares of the contributions add up",
                  {{"parameter", Column::text},
                   {"source", Column::text},
                   {"type", Column::text},
                   {"u", Column::number},
                   {"unit", Column::text},
                   {"share of u²", Column::number}});
  for (const Json& each : list_of(report, "uncertainty_budget")) {
    double total = 0.0;
    for (const Json& line : each.at("lines"))
      total += std::pow(line.at("standard_uncertainty").get<double>(), 2);
    for (const Json& line : each.at("lines")) {
      const double u = line.at("standard_uncertainty").get<double>();
      table.add(
          {text_of(each, "parameter"), text_of(line, "source"), text_of(line, "type"),
           html_number(u, 2), html_unit(each.at("unit").get<std::string>()),
           total > 0.0 ? html_number(std::round(1000.0 * u * u / total) / 10.0, 3) + " %" : "–"});
    }
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
    table.add({text_of(n, "profile"), text_of(n, "scaling"), number_cell(n, "order"),
               html_size(n, "standard_deviation"), number_cell(n, "correlation_mm", 3),
               number_cell(n, "effective_observations", 3),
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

// --- what-if --------------------------------------------------------------------------------

std::string what_if(const Json& report) {
  HtmlTable table("Flatness predicted if one source alone were corrected",
                  {{"profile", Column::text},
                   {"corrected", Column::text},
                   {"peak to valley", Column::number},
                   {"rms", Column::number},
                   {"peak to valley, of the measured", Column::number}});
  std::map<std::string, double> measured;
  for (const Json& each : list_of(report, "what_if")) {
    const std::string profile = each.at("profile").get<std::string>();
    const std::string corrected = each.at("corrected").get<std::string>();
    const double pv = (has(each, "pv_um") ? each.at("pv_um") : each.at("pv_urad")).get<double>();
    if (corrected.empty()) measured[profile] = pv;
    const double whole = measured[profile];
    table.add({escaped(profile),
               corrected.empty()    ? "nothing (as measured)"
               : corrected == "all" ? "all sources of the final model"
                                    : "<b>" + escaped(corrected) + "</b>",
               html_size(each, "pv"), html_size(each, "rms"),
               whole > 0.0 ? html_number(100.0 * pv / whole, 3) + " %" : "–"});
  }
  if (table.empty()) return "";
  return html_section(
      "what-if", "What correcting each source would bring",
      table.html() +
          "<p class=\"hint\">In the low band, each trace levelled anew as the problem file allows. "
          "A "
          "source whose correction makes the face less flat hides another one: correct both or "
          "neither. Where a parameter is not determined, the share of its effect is a "
          "convention.</p>\n");
}

// --- data ---------------------------------------------------------------------------------------

std::string inputs(const Json& report) {
  HtmlTable files("Files", {{"profile", Column::text},
                            {"file", Column::text},
                            {"format", Column::text},
                            {"SHA-256", Column::text}});
  HtmlTable sizes("Profiles", {{"profile", Column::text},
                               {"kind", Column::text},
                               {"role", Column::text},
                               {"samples", Column::number},
                               {"from, mm", Column::number},
                               {"to, mm", Column::number},
                               {"rms", Column::number},
                               {"peak to valley", Column::number},
                               {"missing", Column::number},
                               {"left out", Column::number}});
  HtmlTable outliers(
      "Rows that their neighbours contradict (the largest of each profile); left out "
      "only where the problem file says so",
      {{"profile", Column::text},
       {"row", Column::number},
       {"kind", Column::text},
       {"value", Column::number},
       {"expected", Column::number},
       {"unit", Column::text}});
  std::vector<std::string> remarks;
  for (const Json& in : report.at("inputs")) {
    const std::string name = text_of(in, "name");
    files.add({name, text_of(in, "file"), in.contains("format") ? text_of(in, "format") : "–",
               "<code>" + text_of(in, "sha256") + "</code>"});
    sizes.add({name, text_of(in, "kind") + " " + text_of(in, "quantity"), text_of(in, "role"),
               number_cell(in, "samples", 9), number_cell(in, "position_min_mm", 6),
               number_cell(in, "position_max_mm", 6), html_size(in, "rms"), html_size(in, "pv"),
               number_cell(in, "missing", 9), number_cell(in, "left_out", 9)});
    for (const Json& each : list_of(in, "outliers"))
      outliers.add({name, number_cell(each, "row", 9), text_of(each, "kind"),
                    number_cell(each, "value"), number_cell(each, "expected"),
                    html_unit(each.at("unit").get<std::string>())});
    for (const Json& note : list_of(in, "notes"))
      remarks.push_back(name + ": " + escaped(note.get<std::string>()));
  }
  return files.html() + sizes.html() + outliers.html() + html_list(remarks);
}

std::string setups(const Json& report) {
  HtmlTable table("How each profile was cut and measured", {{"profile", Column::text},
                                                            {"Z, mm", Column::number},
                                                            {"overhang, mm", Column::number},
                                                            {"spindle axis at, mm", Column::number},
                                                            {"feed, mm/min", Column::number},
                                                            {"spindle, rev/min", Column::number},
                                                            {"cut", Column::text},
                                                            {"cut radius, mm", Column::number},
                                                            {"stylus, mm/s", Column::number}});
  for (const Json& s : list_of(report, "setups"))
    table.add({text_of(s, "profile"), number_cell(s, "z_mm"), number_cell(s, "overhang_mm"),
               number_cell(s, "center_mm"), number_cell(s, "feed_mm_per_min"),
               number_cell(s, "spindle_rpm"),
               has(s, "cut_direction") ? text_of(s, "cut_direction") : "–",
               number_cell(s, "cut_radius_mm"), number_cell(s, "traverse_mm_per_s")});
  return table.html();
}

// --- model and options --------------------------------------------------------------------------

std::string model(const Json& report) {
  HtmlTable table("height = sum of these effects + levelling of the trace + noise",
                  {{"effect", Column::text},
                   {"formula", Column::text},
                   {"source", Column::text},
                   {"standard term", Column::text},
                   {"cause", Column::text},
                   {"confounded with", Column::text},
                   {"separated by", Column::text}});
  for (const Json& e : list_of(report, "model"))
    table.add({text_of(e, "name") + (e.at("added").get<bool>() ? " <small>(added)</small>" : ""),
               text_of(e, "formula"), text_of(e, "source"), text_of(e, "standard_name"),
               text_of(e, "cause"), text_of(e, "confounded_with"), text_of(e, "separated_by")});
  return table.html();
}

std::string options(const Json& report) {
  HtmlTable table("Software and options", {{"option", Column::text}, {"value", Column::text}});
  table.add(
      {"software", "slideway " + text_of(report, "version") + ", " + text_of(report, "schema")});
  const Json& low = report.at("low_band");
  table.add({"low band", low.at("level") == 0
                             ? "none, the profiles as they are"
                             : text_of(low, "wavelet") + ", level " + text_of(low, "level") +
                                   ", ends " + text_of(low, "boundary") + ", " +
                                   text_of(low, "values") + " values"});
  if (has(report, "options")) {
    const Json& given = report.at("options");
    std::string bodies;
    for (const Json& body : list_of(given, "bodies"))
      bodies += (bodies.empty() ? "" : ", ") + text_of(body, "name") + " along " +
                text_of(body, "axis") + " on body " + text_of(body, "lower");
    table.add({"lower-body array, Eq. (1)", "0 bed, spindle, workpiece; " + bodies});
    table.add({"lever", text_of(given, "lever")});
    std::string names;
    for (const Json& name : list_of(given, "candidates"))
      names += (names.empty() ? "" : ", ") + escaped(name.get<std::string>());
    table.add({"closed loop", has(report, "trace")
                                  ? "at most " + text_of(given, "max_effects") +
                                        " effects, significance " + text_of(given, "significance")
                                  : "not run"});
    table.add({"candidates of the loop", names});
    for (const Json& prior : list_of(given, "priors"))
      table.add({"prior on " + text_of(prior, "parameter"),
                 html_number(prior.at("value").get<double>(), 6) + ", standard uncertainty " +
                     html_number(prior.at("standard_uncertainty").get<double>(), 3)});
    if (has(given, "runout")) {
      const Json& r = given.at("runout");
      table.add({"run-out, Eq. (21)", "r = " + number_cell(r, "r_um") +
                                          " µm, p = " + number_cell(r, "p_um") +
                                          " µm over L = " + number_cell(r, "diameter_mm") +
                                          " mm, standard uncertainty " +
                                          number_cell(r, "standard_uncertainty_um") + " µm"});
    }
  }
  return table.html();
}

std::string conventions() {
  return "<h3>Units and signs</h3>\n"
         "<p>Positions in mm, heights and deviations in µm, angles in rad; 1 µm/m = "
         "10<sup>−6</sup> rad "
         "= 0.206″. Heights are positive out of the workpiece, along +Z (ISO 841). "
         "Δβ<sub>xz</sub> turns the X motion about +Y and enters the height as "
         "−Δβ<sub>xz</sub> p<sub>x</sub>, Eq. (15): where it is positive, the face falls from the "
         "centre to the rim. Straightness is positive along +Z, from the stated reference line. "
         "A run-out tells the size of the squareness, not its sign. "
         "<i>U</i> = <i>k</i> <i>u</i> covers 95.45 %; <i>k</i> is Student's factor for the "
         "effective "
         "degrees of freedom (GUM G.4.1) and 2 for many.</p>\n";
}

std::string to_fill_in() {
  std::string rows;
  for (const char* what :
       {"Machine: type, serial number, axis configuration", "Date, operator, laboratory",
        "Instrument: make, serial number, calibration due, tip, filter",
        "Workpiece, clamping, tool; when measured after cutting",
        "Temperature at start and end, warm-up", "Compensation active in the control (yes/no)"})
    rows += std::string("<tr><th scope=\"row\">") + what + "</th><td></td></tr>\n";
  return "<div class=\"scroll\" tabindex=\"0\" role=\"group\"><table class=\"fill\"><caption>Not "
         "in the "
         "files, to be filled in (ISO 230-1, ISO/IEC 17025)</caption><tbody>\n" +
         rows + "</tbody></table></div>\n";
}

}  // namespace

std::string html_tables(const Json& report) {
  return what_if(report) + uncertainty(report) + identifiability(report) +
         html_loop_tables(report) + html_section("data", "Data", inputs(report) + setups(report)) +
         html_section("model", "Model and options",
                      model(report) + options(report) + conventions() + to_fill_in());
}

}  // namespace slideway
