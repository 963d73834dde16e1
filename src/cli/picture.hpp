#pragma once

#include <span>
#include <string>

namespace slideway {

/// A profile in braille dots, each dot column from the lowest to the highest value in it; NaN
/// leaves a gap. No line is longer than 80 characters. REQUIRES a number among the values.
std::string picture(std::span<const double> positions, std::span<const double> values);

}  // namespace slideway
