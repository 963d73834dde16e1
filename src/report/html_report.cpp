#include "html_page.hpp"
#include "html_parts.hpp"
#include "slideway/report/report.hpp"

namespace slideway {
namespace {

using Column = HtmlTable::Column;

/// Links to the sections of the page.
std::string contents(const std::string& main) {
  const std::string opening = "<h2 id=\"", middle = "-h\">", end = "</h2>";
  std::string out;
  for (std::size_t at = 0; (at = main.find(opening, at)) != std::string::npos;) {
    const std::size_t id = at + opening.size(), stop = main.find(middle, id);
    const std::size_t title = stop + middle.size();
    at = main.find(end, title);
    out += "<li><a href=\"#" + main.substr(id, stop - id) + "\">" + main.substr(title, at - title) +
           "</a></li>\n";
  }
  return "<nav aria-label=\"Contents\"><ol>\n" + out + "</ol></nav>\n";
}

std::string page_of(const std::string& title, const std::string& subtitle,
                    const std::string& main) {
  const bool charts = main.find("class=\"long\"") != std::string::npos;
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
      title + "</title>\n<style>\n";
  if (charts) out.append(page::kChartStyle);
  out.append(page::kStyle) +=
      "</style>\n</head>\n<body>\n<a class=\"skip\" href=\"#verdict\">Skip to the "
      "verdict</a>\n<header>\n<h1>" +
      title + "</h1>\n<p>" + subtitle + "</p>\n" + contents(main) + "</header>\n<main>\n" + main +
      "</main>\n";
  if (charts) {
    out.append("<script>\n").append(page::kChartScript).append("</script>\n");
    out.append("<script>\n").append(page::kScript).append("</script>\n");
  }
  return out + "</body>\n</html>\n";
}

std::string report_page(const Node& report) {
  const std::string given = html_text(report["title"]);
  const std::string title = given.empty() ? "Carriage errors from a turned face" : given;
  return page_of(title,
                 "Carriage errors of a lathe from the flatness of a turned face · slideway " +
                     html_text(report["version"]),
                 html_verdict(report) + html_pictures(report) + html_tables(report));
}

std::string columns_page(const Node& document) {
  HtmlTable table("Largest coefficient in the low band first",
                  {{"candidate", Column::text},
                   {"raw", Column::number},
                   {"low band", Column::number},
                   {"lag, rows", Column::number},
                   {"at that lag", Column::number},
                   {"effective values", Column::number},
                   {"p", Column::number}});
  for (const Node& row : document["ranking"].entries())
    table.add({html_text(row["candidate"]), html_cell(row["raw"], 3), html_cell(row["low_band"], 3),
               html_cell(row["lag"], 3), html_cell(row["lag_coefficient"], 3),
               html_cell(row["effective_observations"], 3),
               html_probability(row["p_value"].number())});
  return page_of("Correlation with column " + html_text(document["signal"]),
                 html_text(document["file"]) + " · slideway",
                 html_section("verdict", "Ranking", table.html()));
}

}  // namespace

std::string html_report(std::string_view json, const std::string& name) {
  return read_document(json, name, {kReportSchema, kColumnsSchema}, [](const Node& document) {
    return document["schema"].verbatim() == kReportSchema ? report_page(document)
                                                          : columns_page(document);
  });
}

}  // namespace slideway
