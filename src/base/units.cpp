#include "slideway/base/units.hpp"

#include <array>
#include <string>
#include <utility>

namespace slideway {
namespace {

using Entry = std::pair<std::string_view, UnitScale>;

template <std::size_t N>
std::optional<UnitScale> look_up(const std::array<Entry, N>& units, std::string_view name) {
  for (const auto& [unit, scale] : units)
    if (unit == name) return scale;
  return std::nullopt;
}

using Spelling = std::pair<std::string_view, std::string_view>;

// A micro sign has two spellings in Unicode.
constexpr std::array kSpellings{
    Spelling{"m", "m"},
    Spelling{"mm", "mm"},
    Spelling{"um", "um"},
    Spelling{"\u00b5m", "um"},
    Spelling{"\u03bcm", "um"},
    Spelling{"mum", "um"},
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

}  // namespace

std::string_view unit_spelled(std::string_view word) {
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

std::optional<UnitScale> length_unit(std::string_view name) {
  static constexpr std::array<Entry, 5> kUnits{{{"m", {1e3, 1.0}},
                                                {"mm", {1.0, 1.0}},
                                                {"um", {1.0, 1e3}},
                                                {"nm", {1.0, 1e6}},
                                                {"inch", {25.4, 1.0}}}};
  return look_up(kUnits, name);
}

std::optional<UnitScale> slope_unit(std::string_view name) {
  static constexpr std::array<Entry, 6> kUnits{{{"rad", {1.0, 1.0}},
                                                {"mrad", {1.0, 1e3}},
                                                {"urad", {1.0, 1e6}},
                                                {"arcsec", {kArcsecond, 1.0}},
                                                {"um_per_m", {1.0, 1e6}},
                                                {"mm_per_m", {1.0, 1e3}}}};
  return look_up(kUnits, name);
}

std::optional<UnitScale> time_unit(std::string_view name) {
  static constexpr std::array<Entry, 3> kUnits{
      {{"s", {1.0, 1.0}}, {"min", {kMinute, 1.0}}, {"h", {kMinute * kMinute, 1.0}}}};
  return look_up(kUnits, name);
}

}  // namespace slideway
