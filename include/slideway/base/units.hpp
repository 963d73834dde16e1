#pragma once

#include <optional>
#include <string_view>

/// Internally every length (heights too) is in mm, every angle and slope in rad, every time in s.
/// Units are converted on input and output. A variable in another unit has it in its name
/// (`rms_um`).
namespace slideway {

inline constexpr double kMicrometre = 1e-3;  // in mm
inline constexpr double kMetre = 1e3;        // in mm
inline constexpr double kMinute = 60.0;      // in s
inline constexpr double kPi = 3.141592653589793238462643383279502884;
inline constexpr double kMicroradian = 1e-6;
inline constexpr double kArcsecond = kPi / 648000.0;  // in rad

inline constexpr std::string_view kLengthUnits = "m mm um nm inch";
inline constexpr std::string_view kTimeUnits = "s min h";
inline constexpr std::string_view kSlopeUnits = "rad mrad urad arcsec um_per_m mm_per_m";

/// Conversion to the internal unit: value * factor / divisor. One of the two is 1, so that a
/// decimal number in µm is rounded once.
struct UnitScale {
  double factor = 1.0;
  double divisor = 1.0;
  [[nodiscard]] double operator()(double value) const { return value * factor / divisor; }
};

/// Scale of a length unit to mm; nothing if the name is not in kLengthUnits.
std::optional<UnitScale> length_unit(std::string_view name);

/// The name used here of a unit that is written otherwise: "um" for "µm", "MICRONS", "mum"; of a
/// length, a slope, or "s". Empty if the word is no unit.
std::string_view unit_spelled(std::string_view word);

/// Scale of a slope unit to rad; nothing if the name is not in kSlopeUnits.
std::optional<UnitScale> slope_unit(std::string_view name);

/// Scale of a time unit to s; nothing if the name is not in kTimeUnits.
std::optional<UnitScale> time_unit(std::string_view name);

}  // namespace slideway
