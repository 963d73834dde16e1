#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// What to read out of delimited text. What is left empty is found in the text.
struct TableRequest {
  std::vector<std::string> columns;  // header name or 1-based number
  std::string delimiter;             // "," ";" "tab" "blank"
  std::string decimal;               // "." ","
  std::string encoding;              // "utf-8" "utf-16" "latin-1"
  std::optional<int> header_lines;   // lines before the first row of numbers
  bool may_miss = false;             // every column but the first may have missing values
};

/// Columns of numbers out of delimited text.
struct Table {
  std::vector<std::string> names;            // from the header line, or "1", "2", ... without one
  std::vector<std::vector<double>> columns;  // those asked for, in the order asked for
  std::vector<std::string> units;      // of those, as the header has them; empty if it has none
  std::vector<std::string> decisions;  // how the text was taken, a sentence each
  std::string sha256;                  // of the file's bytes
};

/// Rows of a table that follow one another.
struct TablePart {
  const Table& table;  // its names and units
  std::vector<std::span<const double>> columns;
  double share;  // of the bytes, read with this part
};
using TakeRows = std::function<void(const TablePart&)>;

/// Reads columns of delimited text. Columns stand between commas, semicolons, tabs or runs of
/// blanks; numbers have a decimal point or comma; the text is UTF-8, UTF-16 or Latin-1, its lines
/// end in LF or CRLF. Lines that start with '#' and empty ones are passed over, and so are header
/// lines before the first row; names come from the last of them, or the last but one if units
/// follow. A line with a number in a column asked for by number, right before the first row, is a
/// row too, right or wrong. Fields may stand in double quotes; rows may end with delimiters. An
/// empty field, nan, na, n/a, #n/a and null are missing values, NaN in the table. Every value is
/// correctly rounded.
/// @throws DataError   "line 3, column 'z_um': what is wrong": text or infinity for a number,
///                     thousands separators, a missing value where none may be, a short or long
///                     row, a column that is not there or is there twice, no rows, marks that can
///                     be read in two ways
/// @throws UsageError  a delimiter, decimal mark or encoding that is none of the above
Table parse_table(std::string_view bytes, const TableRequest& request);

/// The same, a part at a time: `take` is called with all rows in their order, which the table
/// that comes back does without.
Table parse_table(std::string_view bytes, const TableRequest& request, const TakeRows& take);

/// The same from a file, with no value missing. @throws DataError "path: ..."
Table read_table(const std::filesystem::path& path, std::span<const std::string> columns);

}  // namespace slideway
