#include <algorithm>

#include "brief.hpp"
#include "html_page.hpp"
#include "html_parts.hpp"
#include "json_reader.hpp"
#include "slideway/report/report.hpp"
#include "slideway/trace/analysis_fields.hpp"

namespace slideway {
namespace {

Html meta(const HtmlAttributes& attributes) { return element("meta", attributes) + "\n"; }

Html head(const std::string& title, bool has_charts) {
  Html style = "\n";
  if (has_charts) style += Html::verbatim(page::kChartStyle);
  style += Html::verbatim(page::kStyle);
  return element(
      "head", "\n" + meta({{"charset", "utf-8"}}) +
                  meta({{"http-equiv", "Content-Security-Policy"},
                        {"content",
                         "default-src 'none'; style-src 'unsafe-inline'; script-src "
                         "'unsafe-inline'"}}) +
                  meta({{"name", "viewport"}, {"content", "width=device-width, initial-scale=1"}}) +
                  meta({{"name", "color-scheme"}, {"content", "light dark"}}) +
                  element("title", title) + "\n" + element("style", style) + "\n");
}

Html script(std::string_view text) { return element("script", "\n" + Html::verbatim(text)) + "\n"; }

std::string subject(const Result& result) {
  const auto is_slide = [](const InputSummary& in) { return in.kind == Kind::slide; };
  if (std::ranges::all_of(result.inputs, is_slide))
    return "Straightness of a slide from readings along it";
  return std::ranges::any_of(result.inputs, is_slide)
             ? "Carriage errors of a lathe from turned faces and readings along the slide"
             : "Carriage errors of a lathe from the flatness of a turned face";
}

std::vector<std::string> remarks_on_columns(const Node& low_band, bool filtered) {
  return {filtered ? "Low band: " + low_band["wavelet"].verbatim() + ", level " +
                         std::to_string(low_band["level"].count()) + ", " +
                         low_band["boundary"].verbatim() + "."
                   : "Low band: none (level 0).",
          "Neighbouring values are correlated. The effective values are the independent ones that "
          "would hold the same information.",
          "p is the probability that two unrelated series of so many effective values correlate as "
          "much. A small p does not prove a cause: candidates that are alike correlate alike."};
}

std::string columns_page(const Node& document) {
  const Node low_band = document["low_band"];
  const bool filtered = low_band["level"].count() > 0;
  std::vector<std::pair<Html, HtmlColumn>> columns{{"candidate", HtmlColumn::text},
                                                   {"raw", HtmlColumn::number}};
  if (filtered) columns.emplace_back("low band", HtmlColumn::number);
  for (const char* heading : {"lag, rows", "at that lag", "effective values", "p"})
    columns.emplace_back(heading, HtmlColumn::number);
  HtmlTable table("Largest coefficient first", std::move(columns));
  const auto name = [](const Node& value) {
    return value.is_number() ? html_number(value.number(), 6) : Html(value.verbatim());
  };
  for (const Node& row : document["ranking"].entries()) {
    std::vector<Html> cells{name(row["candidate"]), html_number(row["raw"].number(), 3)};
    if (filtered) cells.push_back(html_number(row["low_band"].number(), 3));
    for (const char* key : {"lag", "lag_coefficient", "effective_observations"})
      cells.push_back(html_number(row[key].number(), 3));
    cells.push_back(html_probability(row["p_value"].number()));
    table.add(cells);
  }
  const Node signal = document["signal"];
  const std::string of = signal.is_number() ? std::to_string(signal.count()) : signal.verbatim();
  return page_of(
      "Correlation with column " + of, document["file"].verbatim() + " · slideway", {},
      {{"verdict", "Ranking", table.html() + html_list(remarks_on_columns(low_band, filtered))}});
}

}  // namespace

std::string page_of(const std::string& title, const std::string& subtitle, const Html& about,
                    const HtmlSections& sections) {
  Html links, main = "\n";
  for (const HtmlSection& each : sections) {
    if (each.body.empty()) continue;
    const std::string heading = each.id + "-h";
    links += element("li", element("a", {{"href", "#" + each.id}}, each.title));
    main += element("section", {{"id", each.id}, {"aria-labelledby", heading}},
                    "\n" + element("h2", {{"id", heading}}, each.title) + each.body);
  }
  const bool has_charts = main.markup().find("class=\"long\"") != std::string::npos;
  const Html header = element("h1", title) + "\n" + element("p", subtitle) + about +
                      element("nav", {{"aria-label", "Contents"}}, element("ol", "\n" + links));
  Html body = "\n" +
              element("a", {{"class", "skip"}, {"href", "#verdict"}}, "Skip to the verdict") +
              "\n" + element("header", header) + "\n" + element("main", main) + "\n";
  if (has_charts) body += script(page::kChartScript) + script(page::kScript);
  return "<!DOCTYPE html>\n" +
         element("html", {{"lang", "en"}},
                 "\n" + head(title, has_charts) + "\n" + element("body", body) + "\n")
             .markup() +
         "\n";
}

std::string html_report(const Analysis& analysis) {
  const Result& result = analysis.result;
  const std::string what = subject(result);
  return page_of(result.title.empty() ? what : result.title, what + " · slideway " + result.version,
                 html_about(result),
                 {html_verdict(analysis), html_face(analysis), html_profiles(analysis),
                  html_straightness(analysis), html_correlation(analysis), html_residual(analysis),
                  html_bands(analysis), html_what_if(analysis), html_uncertainty(analysis),
                  html_identifiability(analysis), html_loop(analysis), html_data(analysis),
                  html_method(analysis), html_certificate(analysis)});
}

std::string html_report(std::string_view json, const std::string& name) {
  return read_document(json, name, {kReportSchema, kBriefSchema, kColumnsSchema},
                       [](const Node& document) {
                         if (document["schema"].verbatim() == kColumnsSchema)
                           return columns_page(document);
                         if (document["schema"].verbatim() == kBriefSchema)
                           return html_brief(document);
                         Analysis analysis;
                         read(document, analysis);
                         return html_report(analysis);
                       });
}

}  // namespace slideway
