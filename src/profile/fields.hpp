#pragma once

#include <string_view>
#include <vector>

// One line of delimited text, taken apart at leisure: the header, the first row, and whatever is
// not regular.
namespace slideway {

inline constexpr char kBlanks = ' ';  // as delimiter: any run of blanks and tabs

inline bool ends_field(char c, char delimiter) {
  return c == delimiter || (delimiter == kBlanks && c == '\t');
}

// The fields of a line, trimmed, without the double quotes around them.
std::vector<std::string_view> split(std::string_view line, char delimiter);

// Whether the field is a number such as "1,5" that means 1.5.
bool has_decimal_comma(std::string_view field);

// ';', tab, ',' or kBlanks, whichever separates the numbers of a row.
char find_delimiter(std::string_view row);

}  // namespace slideway
