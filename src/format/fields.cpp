#include "fields.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

std::string_view without_quotes(std::string_view field) {
  const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return quoted ? trimmed(field.substr(1, field.size() - 2)) : field;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::size_t digits_at(std::string_view text) {
  std::size_t count = 0;
  while (count < text.size() && is_digit(text[count])) ++count;
  return count;
}

bool has_decimal_comma(std::string_view field) {
  const std::size_t comma = field.find(',');
  return comma != std::string_view::npos && comma > 0 && comma + 1 < field.size() &&
         parse_number(field, ',');
}

}  // namespace

std::vector<std::string_view> split(std::string_view line, char delimiter, std::size_t most) {
  if (delimiter == kBlanks) line = trimmed(line);
  std::vector<std::string_view> fields;
  for (std::size_t start = 0; fields.size() < most;) {
    while (start < line.size() && line[start] == ' ') ++start;
    const bool quoted = start < line.size() && line[start] == '"';
    bool inside = false;
    std::size_t stop = start;
    for (; stop < line.size(); ++stop) {
      if (quoted && line[stop] == '"') inside = !inside;
      if (!inside && ends_field(line[stop], delimiter)) break;
    }
    fields.push_back(without_quotes(trimmed(line.substr(start, stop - start))));
    if (stop == line.size()) break;
    start = stop + 1;
    if (delimiter == kBlanks) start = line.find_first_not_of(" \t", start);
  }
  return fields;
}

std::size_t lone_return(std::string_view text) {
  for (std::size_t at = text.find('\r'); at != std::string_view::npos; at = text.find('\r', at)) {
    const std::size_t next = text.find_first_not_of('\r', at);
    if (next == std::string_view::npos) break;
    if (text[next] != '\n') return next - 1;
    at = next;
  }
  return std::string_view::npos;
}

std::optional<double> parse_number(std::string_view field, char decimal) {
  if (decimal == '.') return parse_double(field);
  if (field.find('.') != std::string_view::npos) return std::nullopt;
  std::string text(field);
  const std::size_t mark = text.find(decimal);
  if (mark != std::string::npos) text[mark] = '.';
  return parse_double(text);
}

bool is_missing(std::string_view field) {
  constexpr std::array<std::string_view, 7> kWords{"", "nan", "-nan", "na", "n/a", "#n/a", "null"};
  return std::any_of(kWords.begin(), kWords.end(), [&](std::string_view word) {
    return std::equal(word.begin(), word.end(), field.begin(), field.end(), [](char a, char b) {
      return a == (b >= 'A' && b <= 'Z' ? static_cast<char>(b - 'A' + 'a') : b);
    });
  });
}

bool has_thousands(std::string_view field) {
  constexpr std::array<std::string_view, 8> kSeparators{".",      ",",      " ",      "'",
                                                        "\u2019", "\u00a0", "\u202f", "\xa0"};
  if (!field.empty() && (field[0] == '-' || field[0] == '+')) field.remove_prefix(1);
  const std::size_t first = digits_at(field);
  if (first < 1 || first > 3 || field[0] == '0') return false;
  field.remove_prefix(first);
  const auto* const separator =
      std::find_if(kSeparators.begin(), kSeparators.end(),
                   [&](std::string_view known) { return field.starts_with(known); });
  if (separator == kSeparators.end()) return false;
  while (field.starts_with(*separator)) {
    field.remove_prefix(separator->size());
    if (digits_at(field) != 3) return false;
    field.remove_prefix(3);
  }
  if (field.empty()) return true;
  return (field[0] == '.' || field[0] == ',') && digits_at(field.substr(1)) + 1 == field.size();
}

bool is_numeric(std::string_view field) {
  return !is_missing(field) &&
         (parse_number(field, '.') || parse_number(field, ',') || has_thousands(field));
}

namespace {

// Digits that the text starts with, and what parts them from the rest; taken off the text.
std::optional<unsigned> take_digits(std::string_view& text, std::size_t most,
                                    std::string_view marks) {
  std::size_t count = 0;
  unsigned value = 0;
  for (; count < std::min(most, text.size()) && is_digit(text[count]); ++count)
    value = 10 * value + static_cast<unsigned>(text[count] - '0');
  if (count == 0 || (count < text.size() && marks.find(text[count]) == marks.npos)) return {};
  text.remove_prefix(std::min(text.size(), count + 1));
  return value;
}

// Days from 1970 to a date that the text starts with; taken off the text.
std::optional<double> take_date(std::string_view& text) {
  const bool year_first = text.size() > 4 && text[4] == '-';
  const std::string_view mark = year_first ? "-" : ".";
  const auto first = take_digits(text, year_first ? 4 : 2, mark);
  const auto month = first ? take_digits(text, 2, mark) : std::nullopt;
  const auto last = month ? take_digits(text, year_first ? 2 : 4, "T ") : std::nullopt;
  if (!last) return std::nullopt;
  const std::chrono::year_month_day date{
      std::chrono::year(static_cast<int>(year_first ? *first : *last)), std::chrono::month(*month),
      std::chrono::day(year_first ? *last : *first)};
  if (!date.ok() || date.year() <= std::chrono::year(1970)) return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
}

bool is_zone(std::string_view text) {
  return text.empty() || text == "Z" ||
         ((text[0] == '+' || text[0] == '-') &&
          text.find_first_not_of("0123456789:", 1) == std::string_view::npos);
}

}  // namespace

ClockForm clock_form(std::string_view field) {
  const std::size_t date_end = field.find_first_of("T ");
  const bool has_date = date_end != std::string_view::npos;
  if (has_date) field.remove_prefix(date_end + 1);
  return {has_date, std::string(field.substr(std::min(field.size(), field.find_first_of("Z+-"))))};
}

std::optional<double> clock_time(std::string_view field) {
  double days = 0.0;
  if (const std::size_t end = field.find_first_of("T "); end != std::string_view::npos) {
    const std::optional<double> date = take_date(field);
    if (!date) return std::nullopt;
    days = *date;
  }
  const std::string_view zone = field.substr(std::min(field.size(), field.find_first_of("Z+-")));
  field.remove_suffix(zone.size());
  const auto hour = take_digits(field, 2, ":");
  const auto minute = hour && !field.empty() ? take_digits(field, 2, ":") : std::nullopt;
  if (!minute || *hour > 23 || *minute > 59 || !is_zone(zone)) return std::nullopt;
  double second = 0.0;
  if (!field.empty()) {
    const char mark = field.find(',') == std::string_view::npos ? '.' : ',';
    const auto read = is_digit(field[0]) ? parse_number(field, mark) : std::nullopt;
    if (!read || !(*read < 61.0)) return std::nullopt;
    second = *read;
  }
  return 86400.0 * days + 3600.0 * *hour + 60.0 * *minute + second;
}

char find_delimiter(std::string_view row) {
  row = trimmed(row);
  for (const char c : {';', '\t'})
    if (row.find(c) != std::string_view::npos) return c;
  if (row.find(',') == std::string_view::npos) return kBlanks;
  // "0 2,5" has a blank between decimal commas, "0, 2.5" a comma between decimal points.
  const auto fields = split(row, kBlanks);
  const bool commas =
      fields.size() > 1 && std::all_of(fields.begin(), fields.end(), [](auto f) {
        return parse_double(f) ? digits_at(f.substr(f.size() - 1)) == 1 : has_decimal_comma(f);
      });
  return commas ? kBlanks : ',';
}

}  // namespace slideway
