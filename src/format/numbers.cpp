#include "numbers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::string_view kWhiteSpace(" \t\r\n\f\v\0", 7);

[[noreturn]] void refuse(const std::string& place, std::string_view field, const char* accepted) {
  throw DataError(place + ": '" + printable(field) + "' is not " + accepted);
}

}  // namespace

std::optional<std::string_view> Words::next() {
  text_.remove_prefix(std::min(text_.find_first_not_of(kWhiteSpace), text_.size()));
  if (text_.empty()) return std::nullopt;
  const std::string_view word = text_.substr(0, text_.find_first_of(kWhiteSpace));
  text_.remove_prefix(word.size());
  return word;
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> all;
  Words left(text);
  while (const auto word = left.next()) all.push_back(*word);
  return all;
}

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

double read_number(std::string_view field, const std::string& place) {
  const std::optional<double> number = parse_double(field);
  if (!number || !std::isfinite(*number)) refuse(place, field, "a finite number");
  return *number;
}

double read_positive(std::string_view field, const std::string& place) {
  const double number = read_number(field, place);
  if (!(number > 0.0)) refuse(place, field, "a number above 0");
  return number;
}

void multiply(std::span<double> values, double scale, const std::string& place) {
  for (double& value : values) {
    value *= scale;
    if (std::isinf(value))
      throw DataError(place + ": " + shortest(scale) +
                      "; accepted: one that leaves heights finite");
  }
}

std::size_t read_count(std::string_view field, const std::string& place) {
  constexpr double kMost = 9007199254740992.0;  // whole numbers are exact up to here
  const std::optional<double> number = parse_double(field);
  if (!number || !(*number >= 1.0 && *number <= kMost) || *number != std::floor(*number))
    refuse(place, field, "a whole number above 0 (and at most 2^53)");
  return static_cast<std::size_t>(*number);
}

std::vector<double> read_numbers(std::string_view text, std::size_t count, const std::string& place,
                                 std::span<const std::string_view> missing) {
  check_count(count, text.size() + 1, 2, place);  // a digit and a blank each
  std::vector<double> numbers;
  numbers.reserve(count);
  Words left(text);
  while (const auto word = left.next()) {
    if (numbers.size() == count)
      throw DataError(place + ": more values than the " + std::to_string(count) + " declared");
    if (std::find(missing.begin(), missing.end(), *word) != missing.end())
      numbers.push_back(std::numeric_limits<double>::quiet_NaN());
    else if (const std::optional<double> number = parse_double(*word);
             number && std::isfinite(*number))
      numbers.push_back(*number);
    else
      refuse(place + ", value " + std::to_string(numbers.size() + 1), *word, "a finite number");
  }
  if (numbers.size() < count)
    throw DataError(place + ": " + std::to_string(numbers.size()) + " values where " +
                    std::to_string(count) + " are declared; is the file cut off?");
  return numbers;
}

void check_count(std::size_t count, std::size_t bytes, std::size_t size, const std::string& place) {
  if (count > bytes / size)
    throw DataError(place + ": " + std::to_string(count) + " values are declared, but there are " +
                    std::to_string(bytes) + " bytes; is the file cut off?");
}

void append_little_endian(std::string& bytes, double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  for (unsigned shift = 0; shift < 64; shift += 8)
    bytes += static_cast<char>((bits >> shift) & 0xffU);
}

}  // namespace slideway
