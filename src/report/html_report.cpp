#include "html_page.hpp"
#include "html_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
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

std::string report_page(const Json& report) {
  const std::string given = text_of(report, "title");
  const std::string title = given.empty() ? "Carriage errors from a turned face" : given;
  return page_of(title,
                 "Carriage errors of a lathe from the flatness of a turned face · slideway " +
                     text_of(report, "version"),
                 html_verdict(report) + html_pictures(report) + html_tables(report));
}

std::string columns_page(const Json& document) {
  HtmlTable table("Largest coefficient in the low band first",
                  {{"candidate", Column::text},
                   {"raw", Column::number},
                   {"low band", Column::number},
                   {"lag, rows", Column::number},
                   {"at that lag", Column::number},
                   {"effective values", Column::number},
                   {"p", Column::number}});
  const auto cell = [](const Json& row, const char* key) {
    return html_number(row.at(key).get<double>(), 3);
  };
  for (const Json& row : list_of(document, "ranking"))
    table.add({text_of(row, "candidate"), cell(row, "raw"), cell(row, "low_band"), cell(row, "lag"),
               cell(row, "lag_coefficient"), cell(row, "effective_observations"),
               html_probability(row.at("p_value").get<double>())});
  const std::string title = "Correlation with column " + text_of(document, "signal");
  return page_of(title, text_of(document, "file") + " · slideway",
                 html_section("verdict", "Ranking", table.html()));
}

std::string page_of(const Json& document) {
  if (!document.is_object() || !has(document, "schema"))
    throw DataError(
        "is no report: it has no 'schema'; accepted: slideway.report/1, slideway.columns/1");
  const Json& schema = document.at("schema");
  if (schema == "slideway.report/1") return report_page(document);
  if (schema == "slideway.columns/1") return columns_page(document);
  throw DataError("schema '" +
                  printable(schema.is_string() ? schema.get<std::string>() : schema.type_name()) +
                  "' is not known; accepted: slideway.report/1, slideway.columns/1");
}

}  // namespace

std::string html_report(std::string_view json) {
  try {
    return page_of(Json::parse(json));
  } catch (const Json::parse_error& error) {
    throw DataError("is no JSON: wrong at byte " + std::to_string(error.byte) +
                    "; accepted: what --json writes");
  } catch (const Json::exception& error) {
    const std::string what = error.what();
    throw DataError(
        "is no report of slideway: " + printable(what.substr(what.find("] ") + 2), 120) +
        "; accepted: what --json writes");
  }
}

}  // namespace slideway
