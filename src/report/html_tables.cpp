#include <cmath>
#include <map>

#include "html_parts.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

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
               html_cell(in, "samples", 9), html_cell(in, "position_min_mm", 6),
               html_cell(in, "position_max_mm", 6), html_size(in, "rms"), html_size(in, "pv"),
               html_cell(in, "missing", 9), html_cell(in, "left_out", 9)});
    for (const Json& each : list_of(in, "outliers"))
      outliers.add({name, html_cell(each, "row", 9), text_of(each, "kind"),
                    html_cell(each, "value"), html_cell(each, "expected"),
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
    table.add({text_of(s, "profile"), html_cell(s, "z_mm"), html_cell(s, "overhang_mm"),
               html_cell(s, "center_mm"), html_cell(s, "feed_mm_per_min"),
               html_cell(s, "spindle_rpm"),
               has(s, "cut_direction") ? text_of(s, "cut_direction") : "–",
               html_cell(s, "cut_radius_mm"), html_cell(s, "traverse_mm_per_s")});
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
      table.add({"run-out, Eq. (21)",
                 "r = " + html_cell(r, "r_um") + " µm, p = " + html_cell(r, "p_um") +
                     " µm over L = " + html_cell(r, "diameter_mm") + " mm, standard uncertainty " +
                     html_cell(r, "standard_uncertainty_um") + " µm"});
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
  return what_if(report) + html_uncertainty(report) + html_loop_tables(report) +
         html_section("data", "Data", inputs(report) + setups(report)) +
         html_section("model", "Model and options",
                      model(report) + options(report) + conventions() + to_fill_in());
}

}  // namespace slideway
