#pragma once

#include <string>
#include <string_view>
#include <vector>

// What the lines above the numbers say.
namespace slideway {

// The unit a column's name carries, by our name for it: "z_um", "Height [µm]", "x (mm)",
// "Lateral um"; or empty.
std::string unit_of_name(std::string_view name);

// The unit a field of a units row carries: "mm", "[µm]".
std::string unit_of_field(std::string_view field);

// Whether a line under the names holds units only.
bool is_units_row(const std::vector<std::string_view>& fields);

}  // namespace slideway
