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

/// A JSON report as one self-contained page; the same JSON always makes the same page. A report
/// without curves makes a page without pictures of them.
/// @param name  what the JSON goes by in messages
/// @throws DataError  as read_report()
std::string html_report(std::string_view json, const std::string& name = "report");

/// What the profiles are, the report's `inputs` and `closure` alone: schema "slideway.data/1".
std::string data_json(const Result& result);

/// The same for people: the report down to there.
std::string data_text(const Result& result);

/// The report for people: aligned plain text in at most 80 columns, values with units, at most two
/// digits of uncertainty.
std::string text_report(const Analysis& analysis);

}  // namespace slideway
