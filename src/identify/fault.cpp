#include "slideway/identify/fault.hpp"

#include <algorithm>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::size_t kLongestLine = 200;  // characters that are shown

std::string line_of_file(std::string_view text, int number) {
  for (int line = 1; line < number && !text.empty(); ++line)
    text.remove_prefix(std::min(text.find('\n'), text.size() - 1) + 1);
  const std::string_view line = text.substr(0, text.find('\n'));
  std::string out(line.substr(0, line.find_last_not_of(" \t\r") + 1));
  std::ranges::replace(out, '\t', ' ');
  return printable(out, kLongestLine);
}

std::size_t characters(std::string_view utf8) {
  return static_cast<std::size_t>(std::ranges::count_if(
      utf8, [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; }));
}

/// Where a value that starts at `first` ends: at a comment outside quotes, or with the line.
std::size_t end_of_value(std::string_view line, std::size_t first) {
  bool quoted = false;
  std::size_t at = first;
  for (; at < line.size() && (quoted || line[at] != '#'); ++at) quoted ^= line[at] == '"';
  return line.find_last_not_of(' ', at - 1) + 1;
}

/// Bytes from, to: of the key where it begins an assignment, else of its first occurrence.
std::pair<std::size_t, std::size_t> marked(std::string_view line, const Fault& fault) {
  const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
  const std::size_t key = fault.key.empty() ? std::string_view::npos : line.find(fault.key, begin);
  if (key == std::string_view::npos) return {begin, end_of_value(line, begin)};
  const std::size_t behind = key + fault.key.size();
  const std::size_t equals = line.find_first_not_of("\"' ", behind);
  const bool has_value = equals != std::string_view::npos && line[equals] == '=';
  const std::size_t value = has_value ? line.find_first_not_of(' ', equals + 1) : behind;
  if (fault.is_of_key || value >= line.size()) return {key, behind};
  return {has_value ? value : key, end_of_value(line, has_value ? value : key)};
}

}  // namespace

std::optional<Excerpt> excerpt_of(const Fault& fault) {
  if (fault.file.empty() || fault.line < 1) return std::nullopt;
  try {
    const FileBytes bytes = FileBytes::of_regular_file(fault.file);
    Excerpt out{line_of_file(bytes.text(), fault.line)};
    if (out.line.empty()) return std::nullopt;
    const std::string_view line = out.line;
    const auto [from, to] = marked(line, fault);
    out.first = characters(line.substr(0, from));
    out.count = characters(line.substr(from, to - from));
    return out;
  } catch (const DataError&) {
    return std::nullopt;
  }
}

}  // namespace slideway
