#include "header.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

using Spelling = std::pair<std::string_view, std::string_view>;

// Latin-1 has become UTF-8 before, so a micro sign has two spellings.
constexpr std::array kSpellings{
    Spelling{"m", "m"},
    Spelling{"mm", "mm"},
    Spelling{"um", "um"},
    Spelling{"\u00b5m", "um"},
    Spelling{"\u03bcm", "um"},
    Spelling{"nm", "nm"},
    Spelling{"inch", "inch"},
    Spelling{"in", "inch"},
    Spelling{"s", "s"},
    Spelling{"rad", "rad"},
    Spelling{"mrad", "mrad"},
    Spelling{"urad", "urad"},
    Spelling{"\u00b5rad", "urad"},
    Spelling{"\u03bcrad", "urad"},
    Spelling{"arcsec", "arcsec"},
    Spelling{"um_per_m", "um_per_m"},
    Spelling{"um/m", "um_per_m"},
    Spelling{"\u00b5m/m", "um_per_m"},
    Spelling{"\u03bcm/m", "um_per_m"},
    Spelling{"mm_per_m", "mm_per_m"},
    Spelling{"mm/m", "mm_per_m"},
};

constexpr std::array kWords{
    Spelling{"nanomet", "nm"},  Spelling{"micromet", "um"}, Spelling{"micron", "um"},
    Spelling{"millimet", "mm"}, Spelling{"met", "m"},
};

std::string_view unit_of_word(std::string_view word) {
  for (const auto& [spelling, unit] : kSpellings)
    if (spelling == word) return unit;
  std::string lower(word);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  for (const auto& [stem, unit] : kWords)
    for (const std::string_view end : {"er", "ers", "re", "res", "", "s"})
      if (lower == std::string(stem) + std::string(end) && (stem == "micron") == (end.size() < 2))
        return unit;
  return {};
}

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
  if (const std::string_view unit = unit_of_word(in_brackets(name)); !unit.empty())
    return std::string(unit);
  for (std::size_t at = name.find('_'); at != std::string_view::npos; at = name.find('_', at + 1))
    if (const auto unit = unit_of_word(name.substr(at + 1)); !unit.empty() && at > 0)
      return std::string(unit);
  // A letter or "in" behind a blank can be anything: "Wheel m", "drawn in".
  for (const char mark : {' ', '/'}) {
    const std::size_t at = name.rfind(mark);
    if (at == std::string_view::npos || at == 0) continue;
    const std::string_view word = name.substr(at + 1);
    if (word.size() > 1 && word != "in") {
      if (const auto unit = unit_of_word(word); !unit.empty()) return std::string(unit);
    }
  }
  return {};
}

std::string unit_of_field(std::string_view field) {
  const std::string_view inside = in_brackets(field);
  return std::string(unit_of_word(inside.empty() ? field : inside));
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
