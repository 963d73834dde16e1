#include "slideway/format/table.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "append.hpp"
#include "dialect.hpp"
#include "encoding.hpp"
#include "fields.hpp"
#include "midnight.hpp"
#include "number_at.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/format.hpp"

namespace slideway {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
// Bytes of a chunk, up to the end of a line.
constexpr std::size_t kLargestChunk = 1 << 18, kLeastChunk = kLargestChunk / 4;
constexpr std::size_t kTogether = 8;  // chunks read in parallel

// The rows of a chunk. The memory is reused for the next one.
struct Rows {
  std::vector<std::vector<double>> columns;  // longer than the rows
  std::size_t count = 0;

  [[nodiscard]] std::size_t room() const { return columns[0].size(); }
  void make_room() {
    constexpr std::size_t kLeast = 1 << 12;
    if (count < room()) return;
    for (std::vector<double>& column : columns) column.resize(std::max(kLeast, 2 * count));
  }
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& encoding, const TableRequest& request);

  Table read(const TakeRows& take);

 private:
  struct Target {
    std::size_t column;  // in the file
    std::size_t slot;    // among those asked for
    double value;        // in the current row
    bool may_be_clock = false;
    std::size_t clocks = 0;  // times of a clock that were read
    std::optional<ClockForm> form = {};
  };

  [[nodiscard]] std::string_view rest_of_line(const char* at) const;
  void pass_line(const char* stop);
  bool to_next_line();
  const char* after_plain_row(const char* at, double& first, double& second) const;
  void read_plain_rows(const char* regular_end, Rows& rows);
  void read_rows(Rows& rows);
  Reader take_chunk(std::size_t size);
  [[nodiscard]] std::vector<std::span<const double>> columns_of(const Rows& rows) const;
  [[nodiscard]] bool is_padding(char c) const {
    return c == ' ' || c == '\r' || (c == '\t' && dialect_.delimiter != '\t');
  }
  [[nodiscard]] const char* after_padding(const char* at) const {
    while (is_padding(*at)) ++at;
    return at;
  }
  [[nodiscard]] const char* next_field(const char* at) const;
  const char* read_row(const char* at);
  void read_irregular_row();
  double read_missing(std::string_view field, const Target& target, bool ends_text);
  [[noreturn]] void refuse(const std::string& what) const { refuse_at(at_, what); }
  [[noreturn]] void refuse_at(const char* at, const std::string& what) const {
    const auto line = dialect_.first_line + static_cast<std::size_t>(std::count(first_, at, '\n'));
    throw DataError("line " + std::to_string(line) + what);
  }
  [[nodiscard]] std::string name_of(std::size_t column) const;
  [[noreturn]] void refuse_field(std::string_view field, std::size_t column) const;

  const TableRequest* request_;
  Dialect dialect_;
  const char* first_;  // row of the text
  const char* at_;     // start of the current line
  const char* end_;
  bool last_is_target_ = false;  // nothing but delimiters may follow the last value of a row
  std::size_t missing_ = 0;
  std::vector<Target> targets_;  // by column
};

Reader::Reader(std::string_view text, const std::string& encoding, const TableRequest& request)
    : request_(&request),
      dialect_(find_dialect(text, encoding, request)),
      first_(text.data() + dialect_.first_row),
      at_(first_),
      end_(text.data() + text.size()) {
  const std::vector<std::size_t>& columns = dialect_.columns;
  for (std::size_t slot = 0; slot < columns.size(); ++slot)
    if (std::find(columns.begin(), columns.begin() + slot, columns[slot]) == columns.begin() + slot)
      targets_.push_back({columns[slot], slot, 0.0, std::ranges::count(request.clocks, slot) > 0});
  std::sort(targets_.begin(), targets_.end(),
            [](const Target& a, const Target& b) { return a.column < b.column; });
  last_is_target_ = !targets_.empty() && targets_.back().column + 1 == dialect_.names.size();
}

std::string_view Reader::rest_of_line(const char* at) const {
  const auto size = static_cast<std::size_t>(end_ - at);
  const void* const newline = std::memchr(at, '\n', size);
  return {at, newline ? static_cast<std::size_t>(static_cast<const char*>(newline) - at) : size};
}

// Moves to the next line. The current one has been read up to `stop`.
void Reader::pass_line(const char* stop) {
  at_ = *stop == '\n' ? stop + 1 : std::min(end_, stop + rest_of_line(stop).size() + 1);
}

// Moves to the first line that is neither empty nor a comment, from the current one.
bool Reader::to_next_line() {
  for (; at_ < end_; pass_line(at_)) {
    const char* first = at_;
    while (first < end_ && (*first == ' ' || *first == '\t' || *first == '\r')) ++first;
    if (first < end_ && *first != '\n' && *first != '#') return true;
  }
  return false;
}

// From the start of one field to the start of the next; nullptr if it is the last or quoted.
const char* Reader::next_field(const char* at) const {
  if (*at == '"') return nullptr;
  while (*at != '\n' && !ends_field(*at, dialect_.delimiter)) ++at;
  if (*at == '\n') return nullptr;
  return after_padding(at + 1);
}

// Reads a row of two numbers; returns the next, or nullptr if it holds anything else. REQUIRES a
// newline at its end.
inline const char* Reader::after_plain_row(const char* at, double& first, double& second) const {
  at = number_at(at, end_, dialect_.decimal, first);
  if (!at || *at != dialect_.delimiter) return nullptr;
  at = number_at(at + 1, end_, dialect_.decimal, second);
  if (!at) return nullptr;
  at += *at == '\r';
  return *at == '\n' ? at + 1 : nullptr;
}

// Reads a row into targets_. Returns a position in it after the last value, or nullptr if the row
// is irregular. REQUIRES a newline at its end.
const char* Reader::read_row(const char* at) {
  std::size_t column = 0;
  at = after_padding(at);
  for (Target& target : targets_) {
    for (; column < target.column; ++column)
      if (at = next_field(at); !at) return nullptr;
    at = number_at(at, end_, dialect_.decimal, target.value);
    if (!at) return nullptr;
    if (dialect_.delimiter != kBlanks) at = after_padding(at);
    if (*at != '\n' && *at != '\r' && !ends_field(*at, dialect_.delimiter)) return nullptr;
  }
  return last_is_target_ && *after_padding(at) != '\n' ? nullptr : at;
}

std::string Reader::name_of(std::size_t column) const {
  const std::string& name = dialect_.names[column];
  return "column " + (name == std::to_string(column + 1) ? name : "'" + printable(name, 40) + "'");
}

void Reader::refuse_field(std::string_view field, std::size_t column) const {
  if (field.empty()) refuse(": " + name_of(column) + " is empty");
  const std::string place = ", " + name_of(column) + ": ", shown = "'" + printable(field) + "'";
  if (is_missing(field) || parse_number(field, dialect_.decimal))
    refuse(place + printable(field) + " is no measured value; remove the row or mask it");
  if (has_thousands(field))
    refuse(place + shown + " has a thousands separator; write the number without it");
  const char other = dialect_.decimal == '.' ? ',' : '.';
  const bool mixed = field.find(other) != std::string_view::npos && parse_number(field, other);
  refuse(place + shown + " is no number" +
         (!mixed         ? ""
          : other == ',' ? " with a decimal point, as the numbers before it have"
                         : " with a decimal comma, as the numbers before it have"));
}

double Reader::read_missing(std::string_view field, const Target& target, bool ends_text) {
  // A truncated row can resemble one with a missing last value.
  if (field.empty() && ends_text && last_is_target_ && target.column == targets_.back().column)
    refuse(": the text ends within a row");
  if (!request_->may_miss || target.slot == 0) refuse_field(field, target.column);
  ++missing_;
  return kMissing;
}

// Reads the current row field by field: accepts unusual notation, and names the fault of the rest.
void Reader::read_irregular_row() {
  const std::string_view line = rest_of_line(at_);
  const bool ends_text = line.data() + line.size() == end_;
  const std::size_t needed = targets_.back().column + 1;
  const auto fields = split(line, dialect_.delimiter, needed);
  for (Target& target : targets_) {
    if (target.column >= fields.size())
      refuse(": " + std::to_string(fields.size()) + (fields.size() == 1 ? " field" : " fields") +
             ", expected at least " + std::to_string(needed));
    const std::string_view field = fields[target.column];
    if (is_missing(field)) {
      target.value = read_missing(field, target, ends_text);
      continue;
    }
    auto value = parse_number(field, dialect_.decimal);
    if (!value && target.may_be_clock && (value = clock_time(field))) {
      ++target.clocks;
      const ClockForm form = clock_form(field);
      if (target.form && *target.form != form) refuse(": " + std::string(Midnight::kOneForm));
      target.form = form;
    }
    if (!value || !std::isfinite(*value)) refuse_field(field, target.column);
    target.value = *value;
  }
  const char ends[] = {' ', '\t', '\r', '"', dialect_.delimiter};
  const auto filled = line.find_last_not_of(std::string_view(ends, sizeof ends)) + 1;
  if (last_is_target_ &&
      split(line.substr(0, filled), dialect_.delimiter, needed + 1).size() > needed)
    refuse(": more than " + std::to_string(needed) + (needed == 1 ? " field" : " fields") +
           ", as the rows before it have");
}

// Appends rows of two numbers and a delimiter, up to the first row that holds anything else.
void Reader::read_plain_rows(const char* regular_end, Rows& rows) {
  const bool plain = last_is_target_ && targets_.size() == 2 && targets_[0].column == 0 &&
                     targets_[1].column == 1 && dialect_.delimiter != kBlanks;
  if (!plain) return;
  double* const first = rows.columns[targets_[0].slot].data();
  double* const second = rows.columns[targets_[1].slot].data();
  const char* at = at_;
  std::size_t i = rows.count;
  for (; i < rows.room() && at < regular_end; ++i) {
    const char* next = after_plain_row(at, first[i], second[i]);
    if (!next) break;
    at = next;
  }
  at_ = at;
  rows.count = i;
}

// Appends the rows of the text, or of a chunk of it.
void Reader::read_rows(Rows& rows) {
  rows.columns.resize(dialect_.columns.size());
  rows.count = 0;
  const std::string_view rest(at_, static_cast<std::size_t>(end_ - at_));
  const std::size_t lone = lone_return(rest);
  if (lone != std::string_view::npos) refuse_at(at_ + lone, kLoneReturn);
  const char* const regular_end = at_ + (rest.rfind('\n') + 1);  // at_ if there is no newline
  for (;;) {
    rows.make_room();
    read_plain_rows(regular_end, rows);
    if (rows.count == rows.room()) continue;
    if (!to_next_line()) return;
    const char* stop = at_ < regular_end ? read_row(at_) : nullptr;
    if (!stop) {
      read_irregular_row();
      stop = at_;
    }
    for (const Target& target : targets_) rows.columns[target.slot][rows.count] = target.value;
    ++rows.count;
    pass_line(stop);
  }
}

// A reader of the next `size` bytes, up to the end of a line. This reader continues after them.
Reader Reader::take_chunk(std::size_t size) {
  Reader chunk = *this;
  if (static_cast<std::size_t>(end_ - at_) > size)
    chunk.end_ = std::min(end_, at_ + size + rest_of_line(at_ + size).size() + 1);
  at_ = chunk.end_;
  return chunk;
}

// The requested columns; a repeated request shares its storage.
std::vector<std::span<const double>> Reader::columns_of(const Rows& rows) const {
  std::vector<std::span<const double>> columns;
  for (const std::size_t column : dialect_.columns) {
    const auto target = std::ranges::find(targets_, column, &Target::column);
    columns.push_back(std::span(rows.columns[target->slot]).first(rows.count));
  }
  return columns;
}

// The boundaries and the order of chunks do not depend on the number of threads. Rows are passed on
// while the next chunks are read.
Table Reader::read(const TakeRows& take) {
  Table table;
  table.names = dialect_.names;
  table.units = dialect_.units;
  table.decisions.push_back(dialect_.decision);
  const auto bytes = static_cast<std::size_t>(end_ - at_);
  const std::size_t chunk = std::clamp(bytes / kTogether, kLeastChunk, kLargestChunk);
  struct Batch {
    std::vector<Reader> chunks;
    std::vector<Rows> rows = std::vector<Rows>(kTogether);
  } taken, next;
  std::map<std::size_t, Midnight> midnights;  // by slot
  const auto take_all = [&] {
    for (std::size_t i = 0; i < taken.chunks.size(); ++i) {
      const Reader& part = taken.chunks[i];
      missing_ += part.missing_;
      for (const Target& target : part.targets_)
        if (target.clocks > 0) {
          const std::span values(taken.rows[i].columns[target.slot]);
          midnights[target.slot].count_on(values.first(taken.rows[i].count), target.clocks,
                                          *target.form);
          table.units[target.slot] = "s";
        }
      take({table, columns_of(taken.rows[i]),
            static_cast<double>(part.end_ - first_) / static_cast<double>(bytes)});
    }
  };
  do {
    next.chunks.clear();
    while (at_ < end_ && next.chunks.size() < kTogether && !targets_.empty())
      next.chunks.push_back(take_chunk(chunk));
    parallel_for(next.chunks.size() + 1, [&](std::size_t i) {
      i == 0 ? take_all() : next.chunks[i - 1].read_rows(next.rows[i - 1]);
    });
    std::swap(taken, next);
  } while (!taken.chunks.empty());
  if (!midnights.empty())
    table.decisions.emplace_back("clock times are counted in s from the midnight before the first");
  if (missing_ > 0)
    table.decisions.push_back(std::to_string(missing_) +
                              (missing_ == 1 ? " value is" : " values are") +
                              " missing: empty, nan, na or null");
  return table;
}

}  // namespace

TableHead parse_head(std::string_view bytes, const TableRequest& request) {
  if (bytes.empty()) throw DataError("is empty");
  const DecodedText text = decoded(bytes, request.encoding);
  Dialect dialect = find_dialect(text.bytes(), text.encoding, request);
  return {std::move(dialect.names), std::move(dialect.header_units), std::move(dialect.units),
          std::move(dialect.decision)};
}

Table parse_table(std::string_view bytes, const TableRequest& request, const TakeRows& take) {
  if (bytes.empty()) throw DataError("is empty");
  const DecodedText text = decoded(bytes, request.encoding);
  return Reader(text.bytes(), text.encoding, request).read(take);
}

Table parse_table(std::string_view bytes, const TableRequest& request) {
  std::vector<std::vector<double>> columns(request.columns.size());
  Table table = parse_table(bytes, request, [&](const TablePart& part) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      append(part.columns[i], part.share, columns[i]);
  });
  table.columns = std::move(columns);
  return table;
}

Table read_table(const std::filesystem::path& path, std::span<const std::string> columns) {
  const FileBytes bytes = FileBytes::of_regular_file(path);
  try {
    const Format& format = recognised_format(bytes.text());
    if (&format != formats().back())
      throw DataError("is " + std::string(format.name()) + ", expected delimited text");
    Table table = parse_table(bytes.text(), {.columns = {columns.begin(), columns.end()}});
    table.sha256 = sha256(bytes.text());
    return table;
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  }
}

}  // namespace slideway
