#include "slideway/profile/table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>

#include "fields.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<std::size_t> column_number(std::string_view request) {
  std::size_t number = 0;
  const char* const end = request.data() + request.size();
  const auto [stop, error] = std::from_chars(request.data(), end, number);
  if (error != std::errc() || stop != end || number == 0) return std::nullopt;
  return number - 1;
}

// Whether the first line that holds anything is a row of numbers already. One that is not entirely
// numbers is a header, unless a column asked for by number has a number there: then it is a row
// with a mistake, and must not be passed over.
bool is_row(std::string_view line, std::span<const std::string> requests) {
  const auto fields = split(line, find_delimiter(line));
  const auto is_number = [](std::string_view f) { return parse_double(f).has_value(); };
  const bool any = std::any_of(fields.begin(), fields.end(), is_number);
  if (any && std::all_of(fields.begin(), fields.end(),
                         [&](std::string_view f) { return f.empty() || is_number(f); }))
    return true;
  return std::any_of(requests.begin(), requests.end(), [&](const std::string& request) {
    const auto column = column_number(request);
    return column && *column < fields.size() && is_number(fields[*column]);
  });
}

// The functions that read straight from the bytes look for no end of them: they get only lines that
// end with a newline, and all of them stop there.

// Passes a sign and returns whether it was a minus. No branch, here and where it is used, because
// the signs of heights are as good as random.
std::size_t pass_sign(const char*& at) {
  const std::size_t minus = *at == '-';
  const std::size_t plus = *at == '+';
  at += minus | plus;
  return minus;
}

// Appends the digits at `at` to the mantissa; returns where they end.
const char* read_digits(const char* at, std::uint64_t& mantissa) {
  for (; is_digit(*at); ++at) mantissa = mantissa * 10 + static_cast<unsigned>(*at - '0');
  return at;
}

// Reads the exponent after 'e' or 'E' and adds it; returns where it ends, or nullptr if it is none
// or needs more than four digits.
const char* read_exponent(const char* at, std::ptrdiff_t& exponent) {
  const bool negative = pass_sign(at) == 1;
  const char* const digits = at;
  std::ptrdiff_t value = 0;
  for (; is_digit(*at) && at - digits < 5; ++at) value = value * 10 + (*at - '0');
  if (at == digits || at - digits > 4) return nullptr;
  exponent += negative ? -value : value;
  return at;
}

// The number at `at`, correctly rounded; returns where it ends, or nullptr if there is none.
const char* read_number(const char* at, const char* end, double& value) {
  static constexpr std::array<double, 23> kPowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const char* const start = at;
  const std::size_t minus = pass_sign(at);
  const char* digits = at;
  std::uint64_t mantissa = 0;
  at = read_digits(at, mantissa);
  std::ptrdiff_t count = at - digits;
  std::ptrdiff_t exponent = 0;
  if (*at == '.') {
    digits = ++at;
    at = read_digits(at, mantissa);
    exponent = digits - at;
    count += at - digits;
  }
  if (count == 0) return nullptr;
  if (*at == 'e' || *at == 'E') at = read_exponent(at + 1, exponent);

  // Both operands are exact doubles, so the one operation rounds correctly (Clinger 1990).
  if (at && count <= 19 && mantissa <= (std::uint64_t{1} << 53U) && exponent >= -22 &&
      exponent <= 22) {
    const auto exact = static_cast<double>(mantissa);
    const double size = exponent < 0 ? exact / kPowers[-exponent] : exact * kPowers[exponent];
    static constexpr std::array<double, 2> kSigns{1.0, -1.0};
    value = size * kSigns[minus];
    return at;
  }
  const auto [stop, error] = std::from_chars(start + (*start == '+'), end, value);
  return error == std::errc() ? stop : nullptr;
}

class Reader {
 public:
  Reader(std::string file, std::string_view text) : file_(std::move(file)) {
    if (text.empty()) throw DataError(file_ + ": is empty");
    if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
      throw DataError(file_ + ": is UTF-16 text, expected UTF-8");
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
    at_ = text.data();
    end_ = at_ + text.size();
  }

  Table read(std::span<const std::string> requests);

 private:
  struct Target {
    std::size_t column;  // in the file
    std::size_t slot;    // among those asked for
    double value;        // in the row at hand
  };

  [[nodiscard]] std::string_view line_at(const char* at) const;
  void pass_line(const char* stop);
  bool to_next_line();
  std::vector<std::string> read_names(std::span<const std::string> requests);
  [[nodiscard]] std::size_t find_column(const std::string& request,
                                        const std::vector<std::string>& names) const;
  [[nodiscard]] std::size_t estimate_rows() const;
  [[nodiscard]] bool is_padding(char c) const {
    return c == ' ' || c == '\r' || (c == '\t' && delimiter_ != '\t');
  }
  [[nodiscard]] const char* after_padding(const char* at) const {
    while (is_padding(*at)) ++at;
    return at;
  }
  [[nodiscard]] const char* next_field(const char* at) const;
  const char* read_row(const char* at);
  void read_irregular_row(const std::vector<std::string>& names);
  [[noreturn]] void refuse(const std::string& what) const {
    throw DataError(file_ + ": line " + std::to_string(line_) + what);
  }
  [[noreturn]] void refuse_field(std::string_view field, std::size_t column,
                                 const std::string& name) const;

  std::string file_;
  const char* at_;  // start of the line at hand
  const char* end_;
  std::size_t line_ = 1;
  char delimiter_ = ',';
  std::vector<Target> targets_;  // by column
};

std::string_view Reader::line_at(const char* at) const {
  const auto size = static_cast<std::size_t>(end_ - at);
  const void* const newline = std::memchr(at, '\n', size);
  return {at, newline ? static_cast<std::size_t>(static_cast<const char*>(newline) - at) : size};
}

// Ends the line at hand, of which everything before `stop` has been read.
void Reader::pass_line(const char* stop) {
  at_ = *stop == '\n' ? stop + 1 : std::min(end_, stop + line_at(stop).size() + 1);
  ++line_;
}

// Goes on to the first line, from the one at hand on, that is neither empty nor a comment.
bool Reader::to_next_line() {
  for (; at_ < end_; pass_line(at_)) {
    const char* first = at_;
    while (first < end_ && (*first == ' ' || *first == '\t' || *first == '\r')) ++first;
    if (first < end_ && *first != '\n' && *first != '#') return true;
  }
  return false;
}

// Finds header, delimiter and the first row, and stops there.
std::vector<std::string> Reader::read_names(std::span<const std::string> requests) {
  std::string_view header;
  bool found = to_next_line();
  if (found && !is_row(line_at(at_), requests)) {
    header = line_at(at_);
    pass_line(at_);
    found = to_next_line();
  }
  if (!found) throw DataError(file_ + ": holds no rows of numbers");
  delimiter_ = find_delimiter(line_at(at_));
  std::vector<std::string> names;
  if (!header.empty())
    for (const std::string_view name : split(header, delimiter_))
      names.push_back(printable(name, name.size()));
  for (std::size_t n = split(line_at(at_), delimiter_).size(); names.size() < n;)
    names.push_back(std::to_string(names.size() + 1));
  return names;
}

std::size_t Reader::find_column(const std::string& request,
                                const std::vector<std::string>& names) const {
  const auto name = std::find(names.begin(), names.end(), request);
  if (name != names.end()) {
    if (std::find(name + 1, names.end(), request) != names.end())
      throw DataError(file_ + ": has more than one column '" + request +
                      "'; ask for it by its number");
    return static_cast<std::size_t>(name - names.begin());
  }
  const auto number = column_number(request);
  if (number && *number < names.size()) return *number;
  constexpr std::size_t kListed = 20;
  std::vector<std::string> listed;
  for (const std::string& known : names)
    if (listed.size() < kListed) listed.push_back(printable(known));
  std::string message = file_ + ": no column '" + request + "'; the file has: " + joined(listed);
  if (names.size() > kListed) message += ", ... (" + std::to_string(names.size()) + " columns)";
  throw DataError(message + did_you_mean(request, names));
}

std::size_t Reader::estimate_rows() const {
  const auto rest = static_cast<std::size_t>(end_ - at_);
  const std::size_t sample = std::min<std::size_t>(rest, 4096);
  const auto lines = static_cast<std::size_t>(std::count(at_, at_ + sample, '\n')) + 1;
  // No row is shorter than one character and one delimiter a column.
  return std::min(rest / sample * (lines + 1) + lines, rest / (2 * targets_.back().column + 2) + 1);
}

// From the start of one field to the start of the next; nullptr if it is the last or quoted.
const char* Reader::next_field(const char* at) const {
  if (*at == '"') return nullptr;
  while (*at != '\n' && !ends_field(*at, delimiter_)) ++at;
  if (*at == '\n') return nullptr;
  return after_padding(at + 1);
}

// Reads the row into targets_ in one go; returns a place in it after the last value, or nullptr if
// anything is not regular. REQUIRES a newline at its end.
const char* Reader::read_row(const char* at) {
  std::size_t column = 0;
  at = after_padding(at);
  for (Target& target : targets_) {
    for (; column < target.column; ++column)
      if (at = next_field(at); !at) return nullptr;
    at = read_number(at, end_, target.value);
    if (!at) return nullptr;
    if (delimiter_ != kBlanks) at = after_padding(at);
    if (*at != '\n' && *at != '\r' && !ends_field(*at, delimiter_)) return nullptr;
  }
  return at;
}

void Reader::refuse_field(std::string_view field, std::size_t column,
                          const std::string& name) const {
  std::string place = "column ";
  place += name == std::to_string(column + 1) ? name : "'" + printable(name, 40) + "'";
  if (field.empty()) refuse(": " + place + " is empty");
  place = ", " + place + ": ";
  if (parse_double(field))
    refuse(place + printable(field) + " is no measured value; remove the row or mask it");
  const bool comma = has_decimal_comma(field);
  refuse(place + "'" + printable(field) + "' is no number" +
         (comma ? " (decimal comma? use a decimal point)" : ""));
}

// The same field by field, to take what is merely unusual and say what is wrong with the rest.
void Reader::read_irregular_row(const std::vector<std::string>& names) {
  const auto fields = split(line_at(at_), delimiter_);
  for (Target& target : targets_) {
    if (target.column >= fields.size())
      refuse(": " + std::to_string(fields.size()) + (fields.size() == 1 ? " field" : " fields") +
             ", expected at least " + std::to_string(targets_.back().column + 1));
    const std::string_view field = fields[target.column];
    const auto value = parse_double(field);
    if (!value || !std::isfinite(*value)) refuse_field(field, target.column, names[target.column]);
    target.value = *value;
  }
}

Table Reader::read(std::span<const std::string> requests) {
  Table table;
  table.names = read_names(requests);
  table.columns.resize(requests.size());
  std::vector<std::size_t> columns;
  for (const std::string& request : requests) columns.push_back(find_column(request, table.names));
  for (std::size_t slot = 0; slot < columns.size(); ++slot)
    if (std::find(columns.begin(), columns.begin() + slot, columns[slot]) == columns.begin() + slot)
      targets_.push_back({columns[slot], slot, 0.0});
  if (targets_.empty()) return table;
  std::sort(targets_.begin(), targets_.end(),
            [](const Target& a, const Target& b) { return a.column < b.column; });
  const std::size_t rows = estimate_rows();
  for (const Target& target : targets_) table.columns[target.slot].reserve(rows);

  const std::string_view rest(at_, static_cast<std::size_t>(end_ - at_));
  const char* const regular_end = at_ + (rest.rfind('\n') + 1);  // at_ if there is no newline
  while (to_next_line()) {
    const char* stop = at_ < regular_end ? read_row(at_) : nullptr;
    if (!stop) {
      read_irregular_row(table.names);
      stop = at_;
    }
    for (const Target& target : targets_) table.columns[target.slot].push_back(target.value);
    pass_line(stop);
  }
  for (std::size_t slot = 0; slot < columns.size(); ++slot) {
    const auto first = std::find(columns.begin(), columns.end(), columns[slot]) - columns.begin();
    if (table.columns[slot].empty()) table.columns[slot] = table.columns[first];
  }
  return table;
}

}  // namespace

Table read_table(const std::filesystem::path& path, std::span<const std::string> columns) {
  const FileBytes bytes(path);
  Table table = Reader(path.string(), bytes.text()).read(columns);
  table.sha256 = sha256(bytes.text());
  return table;
}

}  // namespace slideway
