#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

namespace slideway {

struct PictureFrame {
  std::size_t rows = 8;                     // of characters, four dots each
  double low = INFINITY, high = -INFINITY;  // values the scale covers whether they occur or not
};

/// A profile in braille dots, each dot column from the lowest to the highest value in it; NaN
/// leaves a gap. No line is longer than 80 characters. REQUIRES a number among the values.
std::string picture(std::span<const double> positions, std::span<const double> values,
                    const PictureFrame& frame = {});

}  // namespace slideway
