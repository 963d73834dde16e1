#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// What to read from delimited text. Empty members are detected from the text.
struct TableRequest {
  std::vector<std::string> columns;  // header name or 1-based number
  std::string delimiter;             // "," ";" "tab" "blank"
  std::string decimal;               // "." ","
  std::string encoding;              // "utf-8" "utf-16" "latin-1"
  std::optional<int> header_lines;   // lines before the first row of numbers
  bool may_miss = false;             // every column but the first may have missing values
  /// Those of the columns that may be clock times: "08:29:40", "2026-03-12T08:29:40.5",
  /// "12.03.2026 08:29". They become s from the midnight before the first, over midnights on.
  std::vector<std::size_t> clocks = {};
};

/// Columns of numbers read from delimited text.
struct Table {
  std::vector<std::string> names;            // from the header line, or "1", "2", ... without one
  std::vector<std::vector<double>> columns;  // the requested ones, in order
  std::vector<std::string> units;      // of the columns, from the header; empty if it has none
  std::vector<std::string> decisions;  // how the text was parsed, one sentence each
  std::string sha256;                  // of the file's bytes
};

/// What stands above the rows of delimited text, and how they are written.
struct TableHead {
  std::vector<std::string> names;            // of all columns, as in Table
  std::vector<std::string> units;            // of all columns; empty where the header says nothing
  std::vector<std::string> requested_units;  // of the columns asked for
  std::string decision;                      // how the text is parsed, in words
};

/// Consecutive rows of a table.
struct TablePart {
  const Table& table;  // its names and units
  std::vector<std::span<const double>> columns;
  double share;  // of the bytes, read with this part
};
using TakeRows = std::function<void(const TablePart&)>;

/// Reads columns of delimited text. Columns are separated by commas, semicolons, tabs or runs of
/// blanks; numbers have a decimal point or comma; the text is UTF-8, UTF-16 or Latin-1; lines end
/// in LF or CRLF. Lines that start with '#', empty lines, and header lines before the first row are
/// skipped. Names come from the last header line, or from the last but one if units follow. A line
/// directly before the first row with a number in a column requested by number is a row too, valid
/// or not. Fields may be in double quotes; rows may end with delimiters. An empty field, nan, na,
/// n/a, #n/a and null are missing values, NaN in the table. Every value is correctly rounded.
/// @throws DataError   "line 3, column 'z_um': what is wrong": text or infinity for a number, a
///                     thousands separator, a missing value where none is allowed, a short or long
///                     row, an unknown or repeated column, no rows, ambiguous marks, a carriage
///                     return inside a line
/// @throws UsageError  an unknown delimiter, decimal mark or encoding
Table parse_table(std::string_view bytes, const TableRequest& request);

/// What parse_table() finds before it reads a row. @throws DataError, UsageError  as it does
TableHead parse_head(std::string_view bytes, const TableRequest& request);

/// parse_table() in parts: `take` is called with all rows in order; the returned table has none.
Table parse_table(std::string_view bytes, const TableRequest& request, const TakeRows& take);

/// parse_table() of a regular file, without missing values. @throws DataError "path: ..."
Table read_table(const std::filesystem::path& path, std::span<const std::string> columns);

}  // namespace slideway
