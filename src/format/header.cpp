#include "header.hpp"

#include <algorithm>

#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

// What stands between the last brackets, or nothing.
std::string_view in_brackets(std::string_view text) {
  for (const std::string_view pair : {"[]", "()"}) {
    const std::size_t open = text.rfind(pair[0]);
    const std::size_t close = text.find(pair[1], open == std::string_view::npos ? 0 : open);
    if (open != std::string_view::npos && close != std::string_view::npos)
      return trimmed(text.substr(open + 1, close - open - 1));
  }
  return {};
}

}  // namespace

std::string unit_of_name(std::string_view name) {
  if (const std::string_view unit = unit_spelled(in_brackets(name)); !unit.empty())
    return std::string(unit);
  for (std::size_t at = name.find('_'); at != std::string_view::npos; at = name.find('_', at + 1))
    if (const auto unit = unit_spelled(name.substr(at + 1)); !unit.empty() && at > 0)
      return std::string(unit);
  // A letter or "in" behind a blank can be anything: "Wheel m", "drawn in".
  for (const char mark : {' ', '/'}) {
    const std::size_t at = name.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    const std::string_view word = name.substr(at + 1);
    if (word.size() > 1 && word != "in") {
      if (const auto unit = unit_spelled(word); !unit.empty()) return std::string(unit);
    }
  }
  return {};
}

std::string unit_of_field(std::string_view field) {
  const bool bracketed = field.starts_with('[') || field.starts_with('(');
  return std::string(unit_spelled(bracketed ? in_brackets(field) : field));
}

bool is_units_row(const std::vector<std::string_view>& fields) {
  const auto has_unit = [](std::string_view f) { return !unit_of_field(f).empty(); };
  return std::any_of(fields.begin(), fields.end(), has_unit) &&
         std::all_of(fields.begin(), fields.end(), [&](std::string_view f) {
           return f.empty() || has_unit(f) || (f.front() == '[' && f.back() == ']') ||
                  (f.front() == '(' && f.back() == ')');
         });
}

}  // namespace slideway
