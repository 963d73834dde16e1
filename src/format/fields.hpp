#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Parsing of one line of delimited text, for the header, the first rows, and irregular rows.
namespace slideway {

inline constexpr char kBlanks = ' ';  // as delimiter: any run of blanks and tabs

inline bool ends_field(char c, char delimiter) {
  return c == delimiter || (delimiter == kBlanks && c == '\t');
}

// The first fields of a line, at most so many; trimmed, without the double quotes around them.
std::vector<std::string_view> split(std::string_view line, char delimiter,
                                    std::size_t most = std::string_view::npos);

// Position of the first carriage return that does not end its line, or npos. The text after it may
// be a row that would be lost.
std::size_t lone_return(std::string_view text);
inline constexpr const char* kLoneReturn =
    ": a carriage return inside the line; accepted: lines that end in CR LF or LF";

// The value of a field with this decimal mark, NaN and infinity included.
std::optional<double> parse_number(std::string_view field, char decimal);

// An empty field, nan, na, n/a, #n/a, null, in capitals or not.
bool is_missing(std::string_view field);

// "1,234", "1.234,5", "1 234", "1'234.5": digits in groups of three. "0,123" is none.
bool has_thousands(std::string_view field);

// "08:29", "08:29:40.5", both also after a date, "2026-03-12T" or "12.03.2026 ": s from midnight,
// with a date from 1970. What stands behind them of a time zone is left aside.
std::optional<double> clock_time(std::string_view field);

// What all times of one column must have in common. REQUIRES a clock_time().
struct ClockForm {
  bool has_date = false;
  std::string zone;  // "", "Z", "+01:00"

  bool operator==(const ClockForm&) const = default;
};
ClockForm clock_form(std::string_view field);

// Whether the field is a number in any notation.
bool is_numeric(std::string_view field);

// ';', tab, ',' or kBlanks, whichever separates the numbers of a row.
char find_delimiter(std::string_view row);

}  // namespace slideway
