#include "slideway/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <system_error>
#include <tuple>

namespace slideway {
namespace {

constexpr std::string_view kSpace = " \t\r\n\f\v";

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

// Insertions, deletions, replacements and swaps of neighbours that turn a into b (the restricted
// Damerau-Levenshtein distance: no part is edited twice).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        now[j] = std::min(now[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, now);
  }
  return last[b.size()];
}

// Number of bytes of the printable UTF-8 character at the start of the text; 0 if there is none.
std::size_t printable_size(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return lead >= 0x20 && lead != 0x7f ? 1 : 0;
  const std::size_t size = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < size) return 0;
  std::uint32_t code = lead & (0x7fU >> size);
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::uint32_t kSmallest[] = {0xa0, 0x800, 0x10000};  // by size; below 0xa0: controls
  const bool surrogate = code >= 0xd800 && code <= 0xdfff;
  const bool bidi_control =
      (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return code >= kSmallest[size - 2] && code <= 0x10ffff && !surrogate && !bidi_control ? size : 0;
}

}  // namespace

std::optional<double> parse_double(std::string_view field) {
  field = trimmed(field);
  if (field.size() > 1 && field[0] == '+' && field[1] != '-') field.remove_prefix(1);
  double value = 0.0;
  const char* const end = field.data() + field.size();
  const auto [stop, error] = std::from_chars(field.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string significant(double value, int digits) {
  constexpr double kMillion = 1e6;
  std::string text(static_cast<std::size_t>(std::max(digits, 1)) + 16, '\0');
  char* const begin = text.data();
  char* const end = begin + text.size();
  const auto write = [&](double number, std::chars_format format, int precision) {
    return static_cast<std::size_t>(std::to_chars(begin, end, number, format, precision).ptr -
                                    begin);
  };
  std::size_t length = write(value, std::chars_format::general, std::max(digits, 1));
  const bool below_a_million = std::abs(value) >= 1.0 && std::abs(value) < kMillion;
  if (below_a_million && text.find('e') < length) {
    double rounded = value;
    std::from_chars(begin, begin + length, rounded);
    length = write(rounded, std::chars_format::fixed, 0);
  }
  text.resize(length);
  return text;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

std::string joined(std::span<const std::string> words, std::string_view separator) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += separator;
    text += words[i];
  }
  return text;
}

std::string counted(std::size_t count, const std::string& singular) {
  return std::to_string(count) + " " + singular + (count == 1 ? "" : "s");
}

std::string hexadecimal(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (const unsigned char byte : bytes) {
    out += kDigits[byte >> 4U];
    out += kDigits[byte & 15U];
  }
  return out;
}

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string printable(std::string_view text, std::size_t limit) {
  std::string shown;
  for (; !text.empty() && limit > 0; --limit) {
    const std::size_t size = printable_size(text);
    if (size == 0)
      shown += '?';
    else
      shown += text.substr(0, size);
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return text.empty() ? shown : shown + "...";
}

std::string did_you_mean(std::string_view word, std::span<const std::string> accepted) {
  const std::string lower = lower_case(word);
  std::tuple<std::size_t, std::size_t> least(word.size() / 3 + 1, 0);
  const std::string* nearest = nullptr;
  for (const std::string& candidate : accepted) {
    // Edits cannot be fewer than the difference in length.
    if (candidate.size() > word.size() + word.size() / 3) continue;
    const std::tuple distance(edit_distance(lower, lower_case(candidate)),
                              edit_distance(word, candidate));
    if (distance >= least) continue;
    least = distance;
    nearest = &candidate;
  }
  return nearest ? " (did you mean '" + *nearest + "'?)" : "";
}

}  // namespace slideway
