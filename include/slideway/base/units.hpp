#pragma once

#include <optional>
#include <string_view>

/// Units live at the border: inside, every length (heights too) is in mm, every angle and slope in
/// rad, every time in s. Names of variables in another unit carry it (`rms_um`).
namespace slideway {

inline constexpr double kMicrometre = 1e-3;  // in mm
inline constexpr double kMetre = 1e3;        // in mm
inline constexpr double kMinute = 60.0;      // in s
inline constexpr double kPi = 3.141592653589793238462643383279502884;
inline constexpr double kMicroradian = 1e-6;
inline constexpr double kArcsecond = kPi / 648000.0;  // in rad

inline constexpr std::string_view kLengthUnits = "m mm um nm inch";
inline constexpr std::string_view kSlopeUnits = "rad mrad urad arcsec um_per_m mm_per_m";

/// How a number in a unit becomes one of ours: value * factor / divisor. One of the two is 1, so
/// that a decimal number in µm suffers one correct rounding only.
struct UnitScale {
  double factor = 1.0;
  double divisor = 1.0;
  [[nodiscard]] double operator()(double value) const { return value * factor / divisor; }
};

/// Scale of a length unit to mm, or nothing if the name is none of kLengthUnits.
std::optional<UnitScale> length_unit(std::string_view name);

/// Scale of a slope unit to rad, or nothing if the name is none of kSlopeUnits.
std::optional<UnitScale> slope_unit(std::string_view name);

}  // namespace slideway
