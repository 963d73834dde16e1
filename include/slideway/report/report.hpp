#pragma once

#include <string>
#include <string_view>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// The report as JSON, schema "slideway.report/2" (docs/report.schema.json), two blanks of indent
/// and a final newline. Deterministic: keys in a fixed order, numbers in their shortest form that
/// reads back. A number that is not finite is null.
std::string json_report(const Analysis& analysis);

/// The same on one line, without the final newline: part of a longer JSON text.
std::string json_line(const Analysis& analysis);

/// What a table of many reports shows, on one line: schema "slideway.brief/1"
/// (docs/brief.schema.json). Keys and units are those of the report; lists and objects are always
/// there; a number, text or truth that is null, empty, false or a count of 0 is absent.
std::string json_brief(Analysis analysis);

/// A report as one self-contained page; the same report always makes the same page. One without
/// curves makes a page without pictures of them.
std::string html_report(const Analysis& analysis);

/// The same of what json_report(), json_brief() or `rank` on columns wrote.
/// @param name  what the JSON goes by in messages
/// @throws DataError  as read_report()
std::string html_report(std::string_view json, const std::string& name);

/// One picture, a stand-alone SVG: the profile whose residual the loop has lowered most, the final
/// model, and what each model leaves of it.
/// @throws DataError  an analysis without curves
std::string svg_report(const Analysis& analysis);

/// The same of what json_report() wrote. @throws DataError  as read_report()
std::string svg_report(std::string_view json, const std::string& name);

/// What the profiles are, the report's `inputs`, `low_band` and `closure`: schema
/// "slideway.data/1".
std::string data_json(const Result& result);

/// The same for people: the report down to there.
std::string data_text(const Result& result);

struct TextOptions {
  bool full = false;  // all that was found; no sentence of the box is cut, whatever room it needs
  std::string page;   // where the page is; "": none was written
};

/// The report for people in at most 80 columns: first a box with the verdict, of at most six lines
/// unless `full`, then the parameters of the final model, the station heights of a
/// slide, what was assumed, and notes; at most 40 lines unless `full`.
std::string text_report(const Analysis& analysis, const TextOptions& options = {});

}  // namespace slideway
