#include <map>

#include "html_parts.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

// --- what-if --------------------------------------------------------------------------------

std::string what_if(const Node& report) {
  HtmlTable table("Flatness predicted if one source alone were corrected",
                  {{"profile", Column::text},
                   {"corrected", Column::text},
                   {"peak to valley", Column::number},
                   {"rms", Column::number},
                   {"peak to valley, of the measured", Column::number}});
  std::map<std::string, double> measured;
  for (const Node& each : report["what_if"].entries()) {
    const std::string& profile = each["profile"].verbatim();
    const std::string& corrected = each["corrected"].verbatim();
    const double pv = each[each.has("pv_um") ? "pv_um" : "pv_urad"].number();
    if (corrected.empty()) measured[profile] = pv;
    const double whole = measured[profile];
    table.add({escaped(profile),
               corrected.empty()    ? "nothing (as measured)"
               : corrected == "all" ? "all sources of the final model"
                                    : html_bold(corrected),
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

std::string closure(const Node& report) {
  if (!report.has("closure")) return "";
  const Node what = report["closure"];
  HtmlTable table(
      "Closure between lines: what each reads where it meets others, against what they "
      "say; offsets and tilts are free",
      {{"profile", Column::text},
       {"x, mm", Column::number},
       {"y, mm", Column::number},
       {"as the data stand, µm", Column::number},
       {"closure, µm", Column::number},
       {"standard uncertainty, µm", Column::number}});
  for (const Node& each : what["readings"].entries())
    table.add({html_text(each["profile"]), html_cell(each["x_mm"]), html_cell(each["y_mm"]),
               html_cell(each["difference_um"]), html_cell(each["closure_um"]),
               html_cell(each["standard_uncertainty_um"])});
  return table.html() + html_list(html_texts(what["notes"]));
}

std::string inputs(const Node& report) {
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
  for (const Node& in : report["inputs"].entries()) {
    const std::string name = html_text(in["name"]);
    files.add({name, html_text(in["file"]), in.has("format") ? html_text(in["format"]) : "–",
               "<code>" + html_text(in["sha256"]) + "</code>"});
    sizes.add({name, html_text(in["kind"]) + " " + html_text(in["quantity"]), html_text(in["role"]),
               html_cell(in["samples"], 9), html_cell(in["position_min_mm"], 6),
               html_cell(in["position_max_mm"], 6), html_size(in, "rms"), html_size(in, "pv"),
               html_cell(in["missing"], 9), html_cell(in["left_out"], 9)});
    for (const Node& each : in["outliers"].entries())
      outliers.add({name, html_cell(each["row"], 9), html_text(each["kind"]),
                    html_cell(each["value"]), html_cell(each["expected"]), html_unit(each)});
    for (const std::string& note : html_texts(in["notes"])) remarks.push_back(name + ": " + note);
  }
  return files.html() + sizes.html() + outliers.html() + html_list(remarks) + closure(report);
}

std::string setups(const Node& report) {
  HtmlTable table("How each profile was cut and measured", {{"profile", Column::text},
                                                            {"Z, mm", Column::number},
                                                            {"overhang, mm", Column::number},
                                                            {"spindle axis at, mm", Column::number},
                                                            {"feed, mm/min", Column::number},
                                                            {"spindle, rev/min", Column::number},
                                                            {"cut", Column::text},
                                                            {"cut radius, mm", Column::number},
                                                            {"stylus, mm/s", Column::number}});
  for (const Node& s : report["setups"].entries())
    table.add({html_text(s["profile"]), html_cell(s["z_mm"]), html_cell(s["overhang_mm"]),
               html_cell(s["center_mm"]), html_cell(s["feed_mm_per_min"]),
               html_cell(s["spindle_rpm"]),
               s.has("cut_direction") ? html_text(s["cut_direction"]) : "–",
               html_cell(s["cut_radius_mm"]), html_cell(s["traverse_mm_per_s"])});
  return table.html();
}

// --- model and options --------------------------------------------------------------------------

std::string model(const Node& report) {
  HtmlTable table("height = sum of these effects + levelling of the trace + noise",
                  {{"effect", Column::text},
                   {"formula", Column::text},
                   {"source", Column::text},
                   {"standard term", Column::text},
                   {"cause", Column::text},
                   {"confounded with", Column::text},
                   {"separated by", Column::text}});
  for (const Node& e : report["model"].entries())
    table.add({html_text(e["name"]) + (e["added"].truth() ? " <small>(added)</small>" : ""),
               html_text(e["formula"]), html_text(e["source"]), html_text(e["standard_name"]),
               html_text(e["cause"]), html_text(e["confounded_with"]),
               html_text(e["separated_by"])});
  return table.html();
}

void add_options(const Node& report, HtmlTable& table) {
  const Node given = report["options"];
  std::vector<std::string> bodies;
  for (const Node& body : given["bodies"].entries())
    bodies.push_back(html_text(body["name"]) + " along " + html_text(body["axis"]) + " on body " +
                     html_text(body["lower"]));
  table.add({"lower-body array, Eq. (1)", "0 bed, spindle, workpiece; " + joined(bodies)});
  table.add({"lever", html_text(given["lever"])});
  table.add({"closed loop", report.has("trace")
                                ? "at most " + html_text(given["max_effects"]) +
                                      " effects, significance " + html_text(given["significance"])
                                : "not run"});
  table.add({"candidates of the loop", joined(html_texts(given["candidates"]))});
  for (const Node& prior : given["priors"].entries())
    table.add({"prior on " + html_text(prior["parameter"]),
               html_number(prior["value"].number(), 6) + ", standard uncertainty " +
                   html_number(prior["standard_uncertainty"].number(), 3)});
  if (!given.has("runout")) return;
  const Node r = given["runout"];
  table.add({"run-out, Eq. (21)",
             "r = " + html_cell(r["r_um"]) + " µm, p = " + html_cell(r["p_um"]) +
                 " µm over L = " + html_cell(r["diameter_mm"]) + " mm, standard uncertainty " +
                 html_cell(r["standard_uncertainty_um"]) + " µm"});
}

std::string options(const Node& report) {
  HtmlTable table("Software and options", {{"option", Column::text}, {"value", Column::text}});
  table.add({"software",
             "slideway " + html_text(report["version"]) + ", " + html_text(report["schema"])});
  for (const Node& low : report["low_band"].entries())
    table.add({"low band of " + html_text(low["profile"]),
               low["level"].number() == 0.0
                   ? "none, the profile as it is"
                   : html_text(low["wavelet"]) + ", level " + html_text(low["level"]) + ", ends " +
                         html_text(low["boundary"]) + ", " + html_text(low["values"]) + " values"});
  if (report.has("options")) add_options(report, table);
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
  return html_scroll(
             "<table class=\"fill\"><caption>Not in the files, to be filled in (ISO 230-1, ISO/IEC "
             "17025)</caption><tbody>\n" +
             rows + "</tbody></table>") +
         "\n";
}

}  // namespace

std::string html_tables(const Node& report) {
  return what_if(report) + html_uncertainty(report) + html_loop(report) +
         html_section("data", "Data", inputs(report) + setups(report)) +
         html_section("model", "Model and options",
                      model(report) + options(report) + conventions() + to_fill_in());
}

}  // namespace slideway
