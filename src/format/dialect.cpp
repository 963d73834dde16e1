#include "dialect.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "encoding.hpp"
#include "fields.hpp"
#include "header.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

// A header of more bytes than this is none: it is what a file without rows looks like.
constexpr std::size_t kLongestHeader = std::size_t{1} << 20U;
constexpr std::size_t kSampledBytes = std::size_t{1} << 16U;  // of the rows, for the decimal mark

struct Line {
  std::string_view text;
  std::size_t offset = 0, number = 1;
};

std::optional<std::size_t> column_number(std::string_view request) {
  std::size_t number = 0;
  const char* const end = request.data() + request.size();
  const auto [stop, error] = std::from_chars(request.data(), end, number);
  if (error != std::errc() || stop != end || number == 0) return std::nullopt;
  return number - 1;
}

char delimiter_asked(const std::string& name) {
  if (name.empty() || name == "," || name == ";") return name.empty() ? '\0' : name[0];
  if (name == "tab") return '\t';
  if (name == "blank") return kBlanks;
  throw UsageError("delimiter '" + printable(name) + "' is not accepted; accepted: , ; tab blank");
}

// The lines above the first row of numbers, and that row.
class Head {
 public:
  Head(std::string_view text, std::string encoding, const TableRequest& request)
      : text_(text),
        request_(&request),
        encoding_(std::move(encoding)),
        asked_(delimiter_asked(request.delimiter)) {
    for (const std::string& column : request.columns)
      if (const auto number = column_number(column))
        numbers_.push_back(*number);
      else
        words_.push_back(column);
  }

  Dialect dialect();

 private:
  [[nodiscard]] char delimiter_of(std::string_view line) const {
    return asked_ != '\0' ? asked_ : find_delimiter(line);
  }
  [[nodiscard]] bool is_number(std::string_view field) const {
    return is_numeric(field) || (!request_->clocks.empty() && clock_time(field));
  }
  [[nodiscard]] bool is_row(std::string_view line) const;
  [[nodiscard]] bool holds_a_number(std::string_view line) const;
  [[nodiscard]] bool names_all(std::string_view line, char delimiter) const;
  [[nodiscard]] bool names_all(std::string_view line) const;
  [[nodiscard]] std::string utf8(std::string_view field) const {
    return encoding_ == "latin-1" ? utf8_from_latin1(field) : std::string(field);
  }
  [[nodiscard]] std::vector<std::string> fields_of(const Line& line, char delimiter) const;
  [[nodiscard]] std::optional<std::size_t> first_like_the_next() const;
  std::size_t find_first_row();
  void decide_encoding(std::size_t first_row);
  [[nodiscard]] std::vector<std::string> read_header(std::size_t first_row, Dialect& dialect) const;
  [[nodiscard]] std::size_t find_column(const std::string& request,
                                        const std::vector<std::string>& names) const;
  [[nodiscard]] char decimal_of(const Dialect& dialect) const;
  void refuse_ambiguous_commas(const Line& row, const Dialect& dialect,
                               std::size_t named_columns) const;

  std::string_view text_;
  const TableRequest* request_;
  std::string encoding_;
  char asked_;
  std::vector<std::size_t> numbers_;  // columns asked for by number
  std::vector<std::string> words_;    // and by name
  std::vector<Line> lines_;           // neither empty nor comments
};

// A line of nothing but numbers, or with numbers wherever a column is asked for by number.
bool Head::is_row(std::string_view line) const {
  const auto fields = split(line, delimiter_of(line));
  const auto is_one = [this](std::string_view f) { return is_number(f); };
  const auto fits = [this](std::string_view f) { return is_missing(f) || is_number(f); };
  if (std::none_of(fields.begin(), fields.end(), is_one)) return false;
  if (std::all_of(fields.begin(), fields.end(), fits)) return true;
  return !numbers_.empty() && words_.empty() && holds_a_number(line) &&
         std::all_of(numbers_.begin(), numbers_.end(), [&](std::size_t column) {
           return column < fields.size() && fits(fields[column]);
         });
}

bool Head::holds_a_number(std::string_view line) const {
  const auto fields = split(line, delimiter_of(line));
  return std::any_of(numbers_.begin(), numbers_.end(), [&](std::size_t column) {
    return column < fields.size() && is_number(fields[column]);
  });
}

bool Head::names_all(std::string_view line, char delimiter) const {
  const auto fields = split(line, delimiter);
  return std::all_of(words_.begin(), words_.end(), [&](const std::string& word) {
    return std::any_of(fields.begin(), fields.end(), [&](std::string_view field) {
      return field == word || utf8_from_latin1(field) == word;
    });
  });
}

bool Head::names_all(std::string_view line) const {
  if (words_.empty()) return false;
  if (asked_ != '\0') return names_all(line, asked_);
  return names_all(line, ';') || names_all(line, '\t') || names_all(line, ',') ||
         names_all(line, kBlanks);
}

// The first line with numbers in the same fields as the line after it, and as many fields: a row of
// a table that has columns of words, too.
std::optional<std::size_t> Head::first_like_the_next() const {
  std::vector<bool> before;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    std::vector<bool> numbers;
    for (const auto field : split(lines_[i].text, delimiter_of(lines_[i].text)))
      numbers.push_back(is_number(field));
    if (numbers == before && std::ranges::count(numbers, true) > 0) return i - 1;
    before = std::move(numbers);
  }
  return std::nullopt;
}

// Reads lines_ up to the first row and returns its place there. Rows follow the line with the names
// asked for; without names they start where numbers stand.
std::size_t Head::find_first_row() {
  std::size_t number = 1, bytes = 0;
  bool named = false;
  for (std::size_t at = next_content(text_, 0, number); at < text_.size();) {
    lines_.push_back({line_at(text_, at), at, number});
    const Line& line = lines_.back();
    bytes += line.text.size();
    if (lone_return(line.text) != std::string_view::npos)
      throw DataError("line " + std::to_string(number) + kLoneReturn);
    if (const auto row = bytes > kLongestHeader ? first_like_the_next() : std::nullopt;
        row && !named)
      return *row;
    if (bytes > kLongestHeader)
      throw DataError("line " + std::to_string(number) + ": no row of numbers in " +
                      std::to_string(kLongestHeader) + " bytes of header");
    if (request_->header_lines) {
      if (number > static_cast<std::size_t>(*request_->header_lines)) return lines_.size() - 1;
    } else if (named) {
      if (!is_units_row(split(line.text, delimiter_of(line.text)))) return lines_.size() - 1;
    } else if (is_row(line.text)) {
      std::size_t first = lines_.size() - 1;
      while (first > 0 && holds_a_number(lines_[first - 1].text)) --first;
      return first;
    } else {
      named = names_all(line.text);
    }
    at = std::min(text_.size(), at + line.text.size() + 1);
    at = next_content(text_, at, ++number);
  }
  // Nothing is a row. A line is treated as one, to say what is wrong with it.
  if (!named && !request_->header_lines && lines_.size() > 1)
    return first_like_the_next().value_or(1);
  throw DataError("holds no rows of numbers");
}

void Head::decide_encoding(std::size_t first_row) {
  for (std::size_t i = 0; i < first_row; ++i) {
    if (is_utf8(lines_[i].text)) continue;
    if (encoding_ == "utf-8")
      throw DataError("line " + std::to_string(lines_[i].number) +
                      ": is no UTF-8; accepted encodings: utf-8 utf-16 latin-1");
    encoding_ = "latin-1";
  }
}

std::vector<std::string> Head::fields_of(const Line& line, char delimiter) const {
  std::vector<std::string> fields;
  for (const std::string_view field : split(line.text, delimiter)) {
    const std::string text = utf8(field);
    fields.push_back(printable(text, text.size()));
  }
  return fields;
}

// The names; their units go into the dialect, for every column.
std::vector<std::string> Head::read_header(std::size_t first_row, Dialect& dialect) const {
  if (first_row == 0) return {};
  std::size_t line = first_row - 1;
  std::vector<std::string> units;
  if (line > 0 && is_units_row(split(lines_[line].text, dialect.delimiter))) {
    for (const std::string& field : fields_of(lines_[line], dialect.delimiter))
      units.push_back(unit_of_field(field));
    --line;
  }
  for (std::size_t i = first_row; i-- > 0;)
    if (!words_.empty() && names_all(lines_[i].text, dialect.delimiter)) {
      line = i;
      break;
    }
  std::vector<std::string> names = fields_of(lines_[line], dialect.delimiter);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string below = i < units.size() ? units[i] : "";
    dialect.header_units.push_back(below.empty() ? unit_of_name(names[i]) : below);
  }
  return names;
}

std::size_t Head::find_column(const std::string& request,
                              const std::vector<std::string>& names) const {
  const auto name = std::find(names.begin(), names.end(), request);
  if (name != names.end()) {
    if (std::find(name + 1, names.end(), request) != names.end())
      throw DataError("has more than one column '" + request + "'; ask for it by its number");
    return static_cast<std::size_t>(name - names.begin());
  }
  const auto number = column_number(request);
  if (number && *number < names.size()) return *number;
  constexpr std::size_t kListed = 20;
  std::vector<std::string> listed;
  for (const std::string& known : names)
    if (listed.size() < kListed) listed.push_back(printable(known));
  std::string message = "no column '" + request + "'; the file has: " + joined(listed);
  if (names.size() > kListed) message += ", ... (" + std::to_string(names.size()) + " columns)";
  throw DataError(message + did_you_mean(request, names));
}

// The mark of the first number that leaves no doubt; digits in groups of three do, since what
// stands between them may part thousands.
char Head::decimal_of(const Dialect& dialect) const {
  std::string doubtful;
  const std::string_view text = text_.substr(dialect.first_row, kSampledBytes);
  const std::size_t most = *std::max_element(dialect.columns.begin(), dialect.columns.end()) + 1;
  std::size_t number = dialect.first_line;
  for (std::size_t at = next_content(text, 0, number); at < text.size();) {
    const std::string_view line = line_at(text, at);
    const auto fields = split(line, dialect.delimiter, most);
    for (const std::size_t column : dialect.columns) {
      if (column >= fields.size()) continue;
      const std::string_view field = fields[column];
      const std::size_t mark = field.find_first_of(",.");
      if (mark == std::string_view::npos || !parse_number(field, field[mark])) continue;
      if (!has_thousands(field)) return field[mark];
      if (field[mark] == ',' && doubtful.empty())
        doubtful = "line " + std::to_string(number) + ": '" + printable(field) + "'";
    }
    at = next_content(text, std::min(text.size(), at + line.size() + 1), ++number);
  }
  if (!doubtful.empty())
    throw DataError(doubtful +
                    R"( has a decimal comma or a thousands separator; say decimal = "," or ".")");
  return '.';
}

// "1,5,2,5" or "3,759.1,2" under two names: nobody can tell which comma is which.
void Head::refuse_ambiguous_commas(const Line& row, const Dialect& dialect,
                                   std::size_t named_columns) const {
  if (dialect.delimiter != ',' || !request_->decimal.empty() || named_columns < 2) return;
  auto fields = split(row.text, dialect.delimiter);
  while (!fields.empty() && fields.back().empty()) fields.pop_back();
  const std::string place = "line " + std::to_string(row.number) + ": " +
                            std::to_string(fields.size()) + " fields under " +
                            std::to_string(named_columns) + " names; ";
  if (fields.size() == 2 * named_columns)
    throw DataError(place +
                    "decimal commas between commas are ambiguous (if they are none, say decimal = "
                    "\".\")");
  if (!words_.empty() && fields.size() > named_columns)
    throw DataError(place +
                    "a comma within a number is ambiguous (if each is a column, name all, or ask "
                    "for columns by their numbers)");
}

/// How many columns have a name; where none has, all. Separators at the end of a row make none.
std::size_t columns_of(const std::vector<std::string>& names) {
  std::size_t named = 0;
  for (std::size_t i = 0; i < names.size(); ++i)
    named += names[i].empty() || names[i] == std::to_string(i + 1) ? 0 : 1;
  return named > 0 ? named : names.size();
}

std::string in_words(const Dialect& dialect, const std::string& encoding, std::size_t header) {
  std::vector<std::string> parts;
  if (encoding == "utf-16") parts.emplace_back("UTF-16");
  if (encoding == "latin-1") parts.emplace_back("Latin-1");
  parts.emplace_back(dialect.delimiter == ','    ? "commas between columns"
                     : dialect.delimiter == ';'  ? "semicolons between columns"
                     : dialect.delimiter == '\t' ? "tabs between columns"
                                                 : "blanks between columns");
  parts.emplace_back(dialect.decimal == ',' ? "decimal comma" : "decimal point");
  parts.push_back(header == 0   ? "no header"
                  : header == 1 ? "1 header line"
                                : std::to_string(header) + " header lines");
  if (const std::size_t all = columns_of(dialect.names); dialect.columns.size() < all) {
    std::vector<std::string> taken;
    for (const std::size_t column : dialect.columns)
      taken.push_back(printable(dialect.names[column]));
    if (!taken.empty())
      parts.push_back("columns " + joined(taken, " and ") + " of " + std::to_string(all));
  }
  return joined(parts);
}

Dialect Head::dialect() {
  const std::size_t first = find_first_row();
  decide_encoding(first);
  const Line& row = lines_[first];
  Dialect dialect;
  dialect.first_row = row.offset;
  dialect.first_line = row.number;
  dialect.delimiter = delimiter_of(row.text);
  dialect.names = read_header(first, dialect);
  const std::size_t named = dialect.names.size();
  for (std::size_t n = split(row.text, dialect.delimiter).size(); dialect.names.size() < n;)
    dialect.names.push_back(std::to_string(dialect.names.size() + 1));
  dialect.header_units.resize(dialect.names.size());
  for (const std::string& column : request_->columns) {
    dialect.columns.push_back(find_column(column, dialect.names));
    dialect.units.push_back(dialect.header_units[dialect.columns.back()]);
  }
  if (!dialect.columns.empty()) {
    refuse_ambiguous_commas(row, dialect, named);
    dialect.decimal = request_->decimal.empty() ? decimal_of(dialect) : request_->decimal[0];
  }
  dialect.decision = in_words(dialect, encoding_, first);
  return dialect;
}

}  // namespace

std::size_t next_content(std::string_view text, std::size_t at, std::size_t& line) {
  while (at < text.size()) {
    const std::size_t first = text.find_first_not_of(" \t\r", at);
    if (first == std::string_view::npos) break;
    if (text[first] != '\n' && text[first] != '#') return at;
    at = text.find('\n', first);
    if (at == std::string_view::npos) break;
    ++at;
    ++line;
  }
  return text.size();
}

std::string_view line_at(std::string_view text, std::size_t at) {
  return text.substr(at, text.find('\n', at) - at);
}

Dialect find_dialect(std::string_view text, std::string encoding, const TableRequest& request) {
  if (!request.decimal.empty() && request.decimal != "." && request.decimal != ",")
    throw UsageError("decimal '" + printable(request.decimal) + "' is not accepted; accepted: . ,");
  return Head(text, std::move(encoding), request).dialect();
}

}  // namespace slideway
