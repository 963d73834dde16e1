#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// Delimited text with text fields: one header line, then rows.
struct TextRows {
  struct Row {
    std::size_t line = 0;             // in the file, from 1
    std::vector<std::string> fields;  // one per name
  };
  std::size_t line = 0;  // of the header
  std::vector<std::string> names;
  std::vector<Row> rows;
};

/// Parses such a text: columns separated by commas, semicolons or tabs, as in the header; UTF-8,
/// UTF-16 or Latin-1; lines that start with '#' and empty lines are skipped. A field in double
/// quotes may contain the delimiter and doubled quotes. Missing fields at the end of a row are
/// empty.
/// @throws DataError  "line 3: what is wrong": no header, an empty or repeated name, more fields
/// than
///                    names, unclosed quotes
TextRows parse_rows(std::string_view bytes);

}  // namespace slideway
