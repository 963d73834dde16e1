#include "html_parts.hpp"
#include "slideway/base/text.hpp"
#include "slideway/trace/analysis_fields.hpp"

namespace slideway {
namespace {

// --- data ---------------------------------------------------------------------------------------

Html files(const Result& result) {
  HtmlTable table("Files", {{"profile", HtmlColumn::text},
                            {"file", HtmlColumn::text},
                            {"format", HtmlColumn::text},
                            {"SHA-256", HtmlColumn::text}});
  for (const InputSummary& in : result.inputs)
    table.add({in.name, in.file, in.format.empty() ? "–" : in.format, element("code", in.sha256)});
  return table.html();
}

Html sizes(const Result& result) {
  HtmlTable table("Profiles", {{"profile", HtmlColumn::text},
                               {"kind", HtmlColumn::text},
                               {"role", HtmlColumn::text},
                               {"samples", HtmlColumn::number},
                               {"from, mm", HtmlColumn::number},
                               {"to, mm", HtmlColumn::number},
                               {"rms", HtmlColumn::number},
                               {"peak to valley", HtmlColumn::number},
                               {"missing", HtmlColumn::number},
                               {"left out", HtmlColumn::number}});
  for (const InputSummary& in : result.inputs)
    table.add({in.name, Html(text_of(in.kind)) + " " + text_of(in.quantity), text_of(in.role),
               std::to_string(in.samples), html_number(in.position_min_mm, 6),
               html_number(in.position_max_mm, 6), html_size(in.rms_um, in.rms_urad),
               html_size(in.pv_um, in.pv_urad), std::to_string(in.missing),
               std::to_string(in.left_out)});
  return table.html();
}

Html outliers(const Result& result) {
  HtmlTable table(
      "Rows that their neighbours contradict (the largest of each profile); left out only where "
      "the problem file says so",
      {{"profile", HtmlColumn::text},
       {"row", HtmlColumn::number},
       {"kind", HtmlColumn::text},
       {"value", HtmlColumn::number},
       {"expected", HtmlColumn::number},
       {"unit", HtmlColumn::text}});
  for (const InputSummary& in : result.inputs)
    for (const OutlierSummary& each : in.outliers)
      table.add({in.name, std::to_string(each.row), text_of(each.kind), html_number(each.value),
                 html_number(each.expected), unit_name(each.unit)});
  return table.html();
}

Html html_closure(const Result& result) {
  if (!result.closure) return {};
  HtmlTable table(
      "Closure between lines: what each reads where it meets others, against what they say; "
      "offsets and tilts are free",
      {{"profile", HtmlColumn::text},
       {"x, mm", HtmlColumn::number},
       {"y, mm", HtmlColumn::number},
       {"as the data stand, µm", HtmlColumn::number},
       {"closure, µm", HtmlColumn::number},
       {"standard uncertainty, µm", HtmlColumn::number}});
  for (const MisclosureSummary& each : result.closure->readings)
    table.add({each.profile, html_number(each.x_mm), html_number(each.y_mm),
               html_number(each.difference_um), html_number(each.closure_um),
               html_number(each.standard_uncertainty_um)});
  return table.html() + html_list(result.closure->notes);
}

Html input_notes(const Result& result) {
  std::vector<std::string> remarks;
  for (const InputSummary& in : result.inputs) {
    for (const std::string& note : in.notes) remarks.push_back(in.name + ": " + note);
    if (in.loss) remarks.push_back(in.name + ": loss " + std::string(text_of(*in.loss)));
  }
  return html_list(remarks);
}

Html setups(const Details& details) {
  HtmlTable table("How each profile was cut and measured",
                  {{"profile", HtmlColumn::text},
                   {"Z, mm", HtmlColumn::number},
                   {"overhang, mm", HtmlColumn::number},
                   {"spindle axis at, mm", HtmlColumn::number},
                   {"feed, mm/min", HtmlColumn::number},
                   {"spindle, rev/min", HtmlColumn::number},
                   {"cut", HtmlColumn::text},
                   {"cut radius, mm", HtmlColumn::number},
                   {"stylus, mm/s", HtmlColumn::number}});
  for (const ProfileSetup& each : details.setups) {
    const Setup& s = each.setup;
    table.add({each.profile, html_number(s.z_mm), html_number(s.overhang_mm),
               html_number(s.center_mm), html_number(s.feed_mm_per_min), html_number(s.spindle_rpm),
               s.cut_direction ? text_of(*s.cut_direction) : "–", html_number(s.cut_radius_mm),
               html_number(s.traverse_mm_per_s)});
  }
  return table.html();
}

Html html_assumed(const Result& result) {
  HtmlTable table(
      "Assumed: what the problem file does not say",
      {{"key", HtmlColumn::text}, {"taken as", HtmlColumn::text}, {"why", HtmlColumn::text}});
  for (const Assumption& each : result.assumed)
    table.add({element("code", each.key), each.value.empty() ? "–" : value_of(each), each.why});
  return table.html();
}

// --- model and options --------------------------------------------------------------------------

Html model(const Details& details) {
  HtmlTable table("height = sum of these effects + levelling of the trace + noise",
                  {{"effect", HtmlColumn::text},
                   {"formula", HtmlColumn::text},
                   {"source", HtmlColumn::text},
                   {"standard term", HtmlColumn::text},
                   {"cause", HtmlColumn::text},
                   {"confounded with", HtmlColumn::text},
                   {"separated by", HtmlColumn::text}});
  for (const EffectInModel& e : details.effects)
    table.add({Html(effect_title(e.name)) + (e.added ? small(" (added by the loop)") : Html()),
               e.formula, e.source, e.standard_name, e.cause, with_titles(e.confounded_with),
               with_titles(e.separated_by)});
  return table.html();
}

void add_options(const Analysis& analysis, HtmlTable& table) {
  const OptionsSummary& given = *analysis.details.options;
  std::vector<std::string> bodies;
  for (const Body& body : given.bodies)
    bodies.push_back(body.name + " along " + std::string(text_of(body.axis)) + " on body " +
                     std::to_string(body.lower));
  table.add({"lower-body array, Eq. (1)", "0 bed, spindle, workpiece; " + joined(bodies)});
  table.add({"lever", text_of(given.lever)});
  table.add({"closed loop", analysis.trace
                                ? "at most " + Html(std::to_string(given.max_effects)) +
                                      " effects, significance " + html_number(given.significance)
                                : "not run"});
  table.add({"candidates of the loop", effect_titles(given.candidates, ", ")});
  for (const PriorSummary& prior : given.priors)
    table.add({"prior on " + prior.parameter, html_number(prior.value, 6) +
                                                  ", standard uncertainty " +
                                                  html_number(prior.standard_uncertainty, 3)});
  if (!given.runout) return;
  const Runout& r = *given.runout;
  table.add({"run-out, Eq. (21)", "r = " + html_number(r.r_um) + " µm, p = " + html_number(r.p_um) +
                                      " µm over L = " + html_number(r.diameter_mm) +
                                      " mm, standard uncertainty " +
                                      html_number(r.standard_uncertainty_um) + " µm"});
}

Html options(const Analysis& analysis) {
  const Result& result = analysis.result;
  HtmlTable table("Software and options",
                  {{"option", HtmlColumn::text}, {"value", HtmlColumn::text}});
  table.add({"software", "slideway " + result.version + ", " + analysis.schema});
  for (const LowBandSummary& low : result.low_band)
    table.add({"low band of " + low.profile,
               (low.level == 0 ? "none, the profile as it is"
                               : low.wavelet + ", level " + std::to_string(low.level) + ", ends " +
                                     std::string(text_of(low.boundary))) +
                   ", " + counted(low.values, "value")});
  if (analysis.details.options) add_options(analysis, table);
  return table.html();
}

Html gates(const Analysis& analysis) {
  if (!analysis.trace) return {};
  HtmlTable table("Gates of the closed loop, [trace] of the problem file",
                  {{"gate", HtmlColumn::text}, {"value", HtmlColumn::number}});
  for (const auto& [gate, value] : analysis.trace->gates)
    table.add({element("code", gate), html_number(value)});
  Html out = table.html();
  if (analysis.trace->fragile)
    out += element("p", "With " + element("code", analysis.trace->fragile->gate) + " = " +
                            html_number(analysis.trace->fragile->value) + " the verdict would be " +
                            bold(text_of(analysis.trace->fragile->verdict)) + ".");
  return out;
}

Html conventions(const Result& result) {
  Html text = "Positions in mm, heights and deviations in µm, angles in rad; 1 µm/m = 10" +
              element("sup", "−6") + " rad = 0.206″. ";
  if (has_face(result))
    text += "Heights are positive out of the workpiece, along +Z (ISO 841). " +
            html_symbol("Δβ_xz") + " turns the X motion about +Y and enters the height as −" +
            html_symbol("Δβ_xz") + " " + html_symbol("p_x") +
            ", Eq. (15): where it is positive, the face falls from the centre to the rim. A "
            "run-out tells the size of the squareness, not its sign. ";
  text += "Straightness is positive along +Z, from the stated reference line. " + html_symbol("U") +
          " = " + html_symbol("k") + " " + html_symbol("u") + " covers 95.45 %; " +
          html_symbol("k") +
          " is Student's factor for the effective degrees of freedom (GUM G.4.1) and 2 for many.";
  return element("h3", "Units and signs") + element("p", text);
}

}  // namespace

Html html_about(const Result& result) {
  std::vector<Html> out;
  for (const auto& [key, value] : result.about)
    out.push_back(Html(effect_title(key)) + " " + bold(value));
  return out.empty() ? Html() : element("p", joined(out, " · "));
}

HtmlSection html_data(const Analysis& analysis) {
  const Result& result = analysis.result;
  return {"data", "Data",
          files(result) + sizes(result) + outliers(result) + input_notes(result) +
              html_closure(result) + (has_face(result) ? setups(analysis.details) : Html()) +
              html_assumed(result)};
}

HtmlSection html_method(const Analysis& analysis) {
  return {
      "model", "Model and options",
      model(analysis.details) + options(analysis) + gates(analysis) + conventions(analysis.result)};
}

}  // namespace slideway
