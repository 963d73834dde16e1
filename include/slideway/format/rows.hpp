#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// Delimited text whose fields are texts: one header line, then rows.
struct TextRows {
  struct Row {
    std::size_t line = 0;             // in the file, from 1
    std::vector<std::string> fields;  // one per name
  };
  std::size_t line = 0;  // of the header
  std::vector<std::string> names;
  std::vector<Row> rows;
};

/// Reads such a text, written as parse_table() accepts it: columns between commas, semicolons or
/// tabs, whichever the header has; UTF-8, UTF-16 or Latin-1; '#' and empty lines passed over. A
/// field in double quotes may hold the delimiter, and quotes doubled. A row may leave out fields at
/// its end; they are empty.
/// @throws DataError  "line 3: what is wrong": no header, a name that is empty or there twice, more
///                    fields than names, quotes that do not end
TextRows parse_rows(std::string_view bytes);

}  // namespace slideway
