#include <algorithm>

#include "html_parts.hpp"
#include "json_reader.hpp"
#include "slideway/base/units.hpp"

/// The page of a brief report: tables of what it has, without pictures.
namespace slideway {
namespace {

QuantityValue quantity(const Node& node, const char* value, const char* U) {
  QuantityValue out;
  out.value = node[value].number_or_null();
  out.expanded_uncertainty = node[U].number_or_null();
  if (node.has("unit")) out.unit = node["unit"].text();
  return out;
}

std::vector<std::string> texts(const Node& node) {
  std::vector<std::string> out;
  for (const Node& each : node.entries()) out.push_back(each.text());
  return out;
}

/// An effect with the profiles it is confined to.
std::string term(const Node& node, const char* name) {
  const std::vector<std::string> profiles = texts(node["profiles"]);
  const std::string title = effect_title(node[name].text());
  return profiles.empty() ? title : title + " in " + joined(profiles);
}

Html verdict(const Node& trace) {
  if (trace.is_null()) return element("p", "The loop was not run.");
  std::string text = trace["verdict"].text();
  std::ranges::replace(text, '_', ' ');
  Html out = element("strong", {{"class", "badge plain"}}, text);
  if (trace.has("unfinished")) out += " The time limit ended the search.";
  return element("p", {{"class", "verdict"}}, out);
}

Html results(const Node& report) {
  HtmlTable table("Results, expanded uncertainty U (95.45 % coverage)",
                  {{"quantity", HtmlColumn::text},
                   {"value ± U", HtmlColumn::number},
                   {"unit", HtmlColumn::text}});
  const Node model = report["final"];
  if (model.is_null()) return {};
  if (const Node form = model["straightness"]; !form.is_null())
    table.add({"Straightness " + html_symbol("E_ZX") + ", end-point line",
               html_value(quantity(form, "end_point_um", "expanded_uncertainty_um")), "µm"});
  if (const Node check = report["crosscheck"]["squareness"]; !check.is_null())
    table.add(
        {"Squareness", html_value(quantity(check, "fit_rad", "fit_U_rad"), kMicroradian), "µm/m"});
  for (const Node& each : model["parameters"].entries()) {
    const QuantityValue value = quantity(each, "value", "expanded_uncertainty");
    table.add({each["name"].text(), html_value(value), html_unit(value.unit)});
  }
  return table.html();
}

Html accepted(const Node& trace) {
  HtmlTable table("Effects that entered the model", {{"effect", HtmlColumn::text},
                                                     {"ΔBIC", HtmlColumn::number},
                                                     {"p", HtmlColumn::number},
                                                     {"not told apart from", HtmlColumn::text}});
  for (const Node& round : trace["rounds"].entries()) {
    const std::optional<double> p = round["p_value"].number_or_null();
    table.add({term(round, "accepted"), html_number(round["delta_bic"].number_or_null(), 3),
               p ? html_probability(*p) : Html("–"),
               effect_titles(texts(round["ambiguous_with"]), ", ")});
  }
  return table.html();
}

Html limits(const Node& trace) {
  HtmlTable table(
      "Smallest size found with 80 % probability",
      {{"effect", HtmlColumn::text}, {"size", HtmlColumn::number}, {"unit", HtmlColumn::text}});
  for (const Node& limit : trace["detection_limits"].entries())
    table.add({effect_title(limit["effect"].text()),
               html_number(limit["value"].number_or_null(), 2), html_unit(limit["unit"].text())});
  return table.html();
}

Html profiles(const Node& report) {
  HtmlTable table("Profiles", {{"profile", HtmlColumn::text},
                               {"file", HtmlColumn::text},
                               {"rms", HtmlColumn::number},
                               {"residual rms", HtmlColumn::number}});
  const auto size = [](const Node& of) {
    return html_size(of["rms_um"].number_or_null(), of["rms_urad"].number_or_null());
  };
  for (const Node& input : report["inputs"].entries()) {
    Html left = "–";
    if (!report["final"].is_null())
      for (const Node& each : report["final"]["residuals"].entries())
        if (each["profile"].text() == input["name"].text()) left = size(each);
    table.add({input["name"].text(), input["file"].text(), size(input), left});
  }
  return table.html();
}

}  // namespace

std::string html_brief(const Node& report) {
  const Node trace = report["trace"];
  std::vector<std::string> notes = texts(report["notes"]);
  Html found;
  if (!trace.is_null()) {
    for (const std::string& note : texts(trace["notes"])) notes.push_back(with_titles(note));
    found = accepted(trace) + limits(trace);
  }
  if (!report["final"].is_null())
    for (const std::string& note : texts(report["final"]["notes"])) notes.push_back(note);
  const std::string title = report.has("title") ? report["title"].text() : "Carriage errors";
  return page_of(title, "brief report of a batch · slideway " + report["version"].text(),
                 element("p", "identify of this item, or batch --full, makes the whole report."),
                 {{"verdict", "Verdict", verdict(trace) + results(report)},
                  {"loop", "Missing effects", found},
                  {"data", "Data", profiles(report) + html_list(notes)}});
}

}  // namespace slideway
