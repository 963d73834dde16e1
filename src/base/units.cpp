#include "slideway/base/units.hpp"

#include <array>
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

}  // namespace

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

}  // namespace slideway
