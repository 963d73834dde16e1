#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "slideway/format/table.hpp"

namespace slideway {

// How a text is written, and where its rows of numbers begin.
struct Dialect {
  char delimiter = ',';
  char decimal = '.';
  std::size_t first_row = 0;              // offset of the line
  std::size_t first_line = 1;             // its number
  std::vector<std::string> names;         // of all columns
  std::vector<std::string> header_units;  // of all columns; empty where the header says nothing
  std::vector<std::size_t> columns;       // those asked for
  std::vector<std::string> units;         // of those
  std::string decision;                   // all of this in words
};

// @param encoding  of the text as far as known; decided here where the header tells
// @throws DataError, UsageError  as parse_table()
Dialect find_dialect(std::string_view text, std::string encoding, const TableRequest& request);

// The offset of the next line, from the one at `at` on, that is neither empty nor a comment, or the
// text's size; `line` is counted on.
std::size_t next_content(std::string_view text, std::size_t at, std::size_t& line);

// The line at `at`, without its newline.
std::string_view line_at(std::string_view text, std::size_t at);

}  // namespace slideway
