#include "fields.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

std::string_view without_quotes(std::string_view field) {
  const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return quoted ? trimmed(field.substr(1, field.size() - 2)) : field;
}

}  // namespace

std::vector<std::string_view> split(std::string_view line, char delimiter) {
  if (delimiter == kBlanks) line = trimmed(line);
  std::vector<std::string_view> fields;
  for (std::size_t start = 0;;) {
    while (start < line.size() && line[start] == ' ') ++start;
    const bool quoted = start < line.size() && line[start] == '"';
    bool inside = false;
    std::size_t stop = start;
    for (; stop < line.size(); ++stop) {
      if (quoted && line[stop] == '"') inside = !inside;
      if (!inside && ends_field(line[stop], delimiter)) break;
    }
    fields.push_back(without_quotes(trimmed(line.substr(start, stop - start))));
    if (stop == line.size()) return fields;
    start = stop + 1;
    if (delimiter == kBlanks) start = line.find_first_not_of(" \t", start);
  }
}

bool has_decimal_comma(std::string_view field) {
  std::string text(field);
  const std::size_t comma = text.find(',');
  if (comma == 0 || comma >= text.size() - 1) return false;
  text[comma] = '.';
  return parse_double(text).has_value();
}

char find_delimiter(std::string_view row) {
  row = trimmed(row);
  for (const char c : {';', '\t'})
    if (row.find(c) != std::string_view::npos) return c;
  if (row.find(',') == std::string_view::npos) return kBlanks;
  // "1,5 2,5" has blanks between decimal commas, which are refused later.
  const auto fields = split(row, kBlanks);
  return fields.size() > 1 && std::all_of(fields.begin(), fields.end(), has_decimal_comma) ? kBlanks
                                                                                           : ',';
}

}  // namespace slideway
