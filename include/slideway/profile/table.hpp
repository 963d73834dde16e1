#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// Columns of numbers out of delimited text.
struct Table {
  std::vector<std::string> names;            // from the header line, or "1", "2", ... without one
  std::vector<std::vector<double>> columns;  // those asked for, in the order asked for
  std::string sha256;                        // of the file's bytes
};

/// Reads the named columns (header name or 1-based number) of a delimited text file: comma,
/// semicolon, tab or blanks, found from the first row; lines that start with '#' and empty lines
/// are passed over; the first line is the header if it is no row of numbers (a line with a number
/// in a column asked for by number is a row, right or wrong). LF or CRLF, UTF-8 with or without
/// BOM; fields may stand in double quotes. Every value is correctly rounded.
/// @throws DataError naming file, line and column: text, NaN or infinity for a number, an empty
///                   field, a decimal comma, a short row, a column that is not there or is there
///                   twice, no rows, no file.
Table read_table(const std::filesystem::path& path, std::span<const std::string> columns);

}  // namespace slideway
