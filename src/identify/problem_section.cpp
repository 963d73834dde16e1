#include "problem_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

const TomlValue::Table kNoEntries;
constexpr double kLargest = 1e9, kSmallest = 1e-9;

std::optional<double> as_number(const TomlValue& value) {
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&value.data))
    return static_cast<double>(*whole);
  return std::nullopt;
}

/// Nothing but blanks, those that have no width among them.
bool is_blank(std::string text) {
  for (const std::string_view blank :
       {"\u00a0", "\u200b", "\u200c", "\u200d", "\u200e", "\u200f", "\u2060", "\ufeff"})
    for (std::size_t at = 0; (at = text.find(blank)) != std::string::npos;)
      text.erase(at, blank.size());
  return trimmed(text).empty();
}

}  // namespace

std::vector<std::string> words(std::string_view list) {
  std::istringstream stream{std::string(list)};
  std::vector<std::string> result;
  for (std::string word; stream >> word;) result.push_back(word);
  return result;
}

Section::Section(const std::string& file, std::string name, const TomlValue& value, Faults* faults)
    : file_(&file),
      name_(std::move(name)),
      line_(value.line),
      table_(std::get_if<TomlValue::Table>(&value.data)),
      faults_(faults) {
  if (table_ == nullptr) {
    table_ = &kNoEntries;
    fail("", "must be a table, [" + name_ + "]");
  }
}

void Section::accept(std::span<const std::string> keys) const {
  for (const TomlEntry& entry : *table_)
    if (std::find(keys.begin(), keys.end(), entry.key) == keys.end())
      refuse_key(entry.key, "unknown key" + did_you_mean(entry.key, keys) +
                                "; accepted: " + joined(keys, " "));
}

std::vector<std::string> Section::keys() const {
  std::vector<std::string> result;
  for (const TomlEntry& entry : *table_) result.push_back(entry.key);
  return result;
}

std::map<std::string, int> Section::lines() const {
  std::map<std::string, int> result{{"", line_}};
  for (const TomlEntry& entry : *table_) result[entry.key] = entry.line;
  return result;
}

const TomlEntry* Section::find(std::string_view key) const {
  const auto at = std::find_if(table_->begin(), table_->end(),
                               [&](const TomlEntry& entry) { return entry.key == key; });
  return at == table_->end() ? nullptr : &*at;
}

std::optional<double> Section::number(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const std::optional<double> value = as_number(entry->value);
  if (value && std::isfinite(*value)) return value;
  refuse(key, is_text(key) ? "must be a number, without quotes" : "must be a finite number");
  return std::nullopt;
}

std::optional<double> Section::positive(std::string_view key) const {
  const std::optional<double> value = number(key);
  if (!value || *value > 0.0) return value;
  refuse(key, "must be greater than 0, not " + shortest(*value));
  return std::nullopt;
}

std::optional<double> Section::coordinate(std::string_view key, double most) const {
  const std::optional<double> value = number(key);
  if (!value || std::abs(*value) <= most) return value;
  refuse(key, shortest(*value) + " is out of range; accepted: from -" + significant(most, 1) +
                  " to " + significant(most, 1));
  return std::nullopt;
}

std::optional<double> Section::magnitude(std::string_view key) const {
  const std::optional<double> value = positive(key);
  if (!value || (*value >= kSmallest && *value <= kLargest)) return value;
  refuse(key, shortest(*value) + " is out of range; accepted: from 1e-9 to 1e9");
  return std::nullopt;
}

std::optional<double> Section::not_negative(std::string_view key) const {
  const std::optional<double> value = number(key);
  if (!value || *value >= 0.0) return value;
  refuse(key, "must be 0 or greater, not " + shortest(*value));
  return std::nullopt;
}

std::optional<bool> Section::flag(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* value = std::get_if<bool>(&entry->value.data);
  if (value == nullptr) fail(key, "must be true or false");
  return *value;
}

std::optional<int> Section::integer(std::string_view key, int lowest, int highest) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* value = std::get_if<std::int64_t>(&entry->value.data);
  if (value != nullptr && *value >= lowest && *value <= highest) return static_cast<int>(*value);
  refuse(key, "must be a whole number from " + std::to_string(lowest) + " to " +
                  std::to_string(highest) +
                  (value == nullptr ? "" : ", not " + std::to_string(*value)));
  return std::nullopt;
}

std::optional<std::string> Section::text(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* value = std::get_if<std::string>(&entry->value.data);
  if (value != nullptr && !is_blank(*value) && printable(*value, value->size()) == *value)
    return *value;
  refuse(key, "must be a text on one line that is not empty, \"...\"");
  return std::nullopt;
}

std::optional<std::string> Section::column(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr || !std::holds_alternative<std::int64_t>(entry->value.data))
    return text(key);
  const std::optional<int> number = integer(key, 1, std::numeric_limits<int>::max());
  return number ? std::optional(std::to_string(*number)) : std::nullopt;
}

namespace {

std::optional<std::array<double, 2>> pair_of_numbers(const TomlValue& value) {
  const auto* array = std::get_if<TomlValue::Array>(&value.data);
  if (array == nullptr || array->size() != 2) return std::nullopt;
  const std::optional<double> first = as_number((*array)[0]), second = as_number((*array)[1]);
  if (!first || !second || !std::isfinite(*first) || !std::isfinite(*second)) return std::nullopt;
  return std::array{*first, *second};
}

std::optional<std::pair<double, double>> range_in(const TomlValue& value) {
  const auto pair = pair_of_numbers(value);
  if (!pair || !((*pair)[0] < (*pair)[1])) return std::nullopt;
  return std::pair((*pair)[0], (*pair)[1]);
}

}  // namespace

std::optional<std::pair<double, double>> Section::range(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  const auto range = range_in(find(key)->value);
  if (!range) refuse(key, "must be two finite numbers, the smaller one first: [0.0, 10.0]");
  return range;
}

std::vector<std::pair<double, double>> Section::ranges(std::string_view key) const {
  if (!has(key)) return {};
  std::vector<std::pair<double, double>> out;
  const auto* array = std::get_if<TomlValue::Array>(&find(key)->value.data);
  for (const TomlValue& element : array ? *array : TomlValue::Array{})
    if (const auto range = range_in(element)) out.push_back(*range);
  if (!array || out.size() != array->size())
    refuse(key, "must be a list of ranges, each with the smaller number first: [[120.0, 140.0]]");
  return out;
}

std::optional<std::array<double, 2>> Section::point(std::string_view key) const {
  if (!has(key)) return std::nullopt;
  const auto pair = pair_of_numbers(find(key)->value);
  if (pair && std::abs((*pair)[0]) <= kLargest && std::abs((*pair)[1]) <= kLargest) return pair;
  refuse(key, "must be a place [x, y]: two numbers, 1e9 mm at most");
  return std::nullopt;
}

bool Section::is_text(std::string_view key) const {
  const TomlEntry* entry = find(key);
  return entry != nullptr && std::holds_alternative<std::string>(entry->value.data);
}

std::optional<std::vector<std::size_t>> Section::indices(std::string_view key,
                                                         const std::string& what) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* array = std::get_if<TomlValue::Array>(&entry->value.data);
  std::vector<std::size_t> result;
  for (const TomlValue& element : array ? *array : TomlValue::Array{})
    if (const auto* index = std::get_if<std::int64_t>(&element.data); index && *index > 0)
      result.push_back(static_cast<std::size_t>(*index));
  if (array != nullptr && result.size() == array->size()) return result;
  refuse(key, what);
  return std::nullopt;
}

bool Section::check_word(std::string_view key, const std::string& word,
                         std::span<const std::string> accepted, std::string_view where,
                         const std::string& meant) const {
  if (std::find(accepted.begin(), accepted.end(), word) != accepted.end()) return true;
  refuse(key, "\"" + word + "\" is not accepted" + std::string(where) + meant +
                  (accepted.empty() ? "; there is none" : "; accepted: " + joined(accepted, " ")));
  return false;
}

std::optional<std::string> Section::one_of(std::string_view key,
                                           std::span<const std::string> accepted,
                                           std::string_view where) const {
  std::optional<std::string> value = text(key);
  const bool refused =
      value && !check_word(key, *value, accepted, where, did_you_mean(*value, accepted));
  return refused ? std::nullopt : value;
}

std::optional<std::string> Section::unit(std::string_view key, std::string_view accepted,
                                         std::string_view where) const {
  std::optional<std::string> value = text(key);
  if (!value) return value;
  if (*value == "\u00b5m" || *value == "\u03bcm") value = "um";
  const std::vector<std::string> units = words(accepted);
  const std::string means(unit_spelled(*value));
  const bool is_known = std::ranges::count(units, means) > 0;
  const bool fits =
      check_word(key, *value, units, where, is_known ? " (did you mean '" + means + "'?)" : "");
  return fits ? value : std::nullopt;
}

std::optional<std::vector<std::string>> Section::some_of(
    std::string_view key, std::span<const std::string> accepted) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  const auto* array = std::get_if<TomlValue::Array>(&entry->value.data);
  std::vector<std::string> result;
  for (const TomlValue& element : array ? *array : TomlValue::Array{})
    if (const auto* word = std::get_if<std::string>(&element.data)) result.push_back(*word);
  if (array == nullptr || result.size() != array->size()) {
    refuse(key, "must be a list of texts; accepted: " + joined(accepted, " "));
    return std::nullopt;
  }
  bool fits = true;
  for (const std::string& word : result)
    fits = check_word(key, word, accepted, "", did_you_mean(word, accepted)) && fits;
  return fits ? std::optional(std::move(result)) : std::nullopt;
}

std::vector<std::string> Section::texts(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return {};
  const auto* array = std::get_if<TomlValue::Array>(&entry->value.data);
  std::vector<std::string> result;
  for (const TomlValue& element : array ? *array : TomlValue::Array{})
    if (const auto* text = std::get_if<std::string>(&element.data)) result.push_back(*text);
  if (!array || result.size() != array->size()) refuse(key, "must be a list of texts, [\"...\"]");
  return result;
}

std::optional<Section> Section::table(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return std::nullopt;
  return Section(*file_, called(key), entry->value, faults_);
}

std::vector<Section> Section::tables(std::string_view key) const {
  const TomlEntry* entry = find(key);
  if (entry == nullptr) return {};
  const auto* array = std::get_if<TomlValue::Array>(&entry->value.data);
  if (array == nullptr) fail(key, "must be a list of tables, [[" + called(key) + "]]");
  std::vector<Section> result;
  for (const TomlValue& element : *array) {
    std::string name = called(key);
    if (element.line == 0) name.append("[").append(std::to_string(result.size())).append("]");
    result.emplace_back(*file_, name, element, faults_);
  }
  return result;
}

std::string Section::called(std::string_view key) const {
  if (name_.empty() || key.empty()) return name_ + std::string(key);
  return name_ + "." + std::string(key);
}

void Section::missing(std::string_view key, std::string_view accepted) const {
  fail(key, "missing; accepted: " + std::string(accepted));
}

void Section::fail(std::string_view key, const std::string& what) const {
  throw FaultError(fault(key, what));
}

void Section::refuse(std::string_view key, const std::string& what) const {
  if (faults_ == nullptr) fail(key, what);
  keep(fault(key, what));
}

void Section::refuse_key(std::string_view key, const std::string& what) const {
  Fault unknown = fault(key, what);
  unknown.is_of_key = true;
  if (faults_ == nullptr) throw FaultError(unknown);
  keep(unknown);
}

Fault Section::fault(std::string_view key, const std::string& what) const {
  const TomlEntry* entry = find(key);
  // The root's own line is no place to send anybody to.
  const int line = entry != nullptr ? entry->line : name_.empty() ? 0 : line_;
  const std::string message =
      *file_ + (line > 0 ? ":" + std::to_string(line) : "") + ": " + called(key) + ": " + what;
  // A quoted key may hold anything.
  return {.message = bounded_message(printable(message, message.size())),
          .file = *file_,
          .line = line,
          .key = entry != nullptr ? std::string(key) : ""};
}

void Section::keep_data(const DataError& error) const {
  Fault of_data = fault("file", "");
  of_data.message = error.what();
  of_data.is_of_data = true;
  keep(of_data);
}

void Section::keep(const Fault& fault) const {
  if (std::ranges::count(*faults_, fault.message, &Fault::message) == 0) faults_->push_back(fault);
}

}  // namespace slideway
