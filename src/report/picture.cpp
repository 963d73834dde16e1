#include "slideway/report/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::size_t kColumns = 66;  // of characters, 2 by 4 dots each
constexpr std::size_t kWide = 2 * kColumns;

struct Extent {
  double low = INFINITY, high = -INFINITY;
  [[nodiscard]] bool is_empty() const { return !(low <= high); }
  void add(double value) {
    low = std::fmin(low, value);
    high = std::fmax(high, value);
  }
  /// Which of `count` equal parts a value lies in.
  [[nodiscard]] std::size_t part(double value, std::size_t count) const {
    if (!(high > low)) return count / 2;
    const double share = (value / 2 - low / 2) / (high / 2 - low / 2);  // halves do not overflow
    return std::min(count - 1,
                    static_cast<std::size_t>(std::max(0.0, share) * static_cast<double>(count)));
  }
};

std::string braille(unsigned dots) {  // U+2800 and a bit for each dot
  return {static_cast<char>(0xe2), static_cast<char>(0xa0U | dots >> 6U),
          static_cast<char>(0x80U | (dots & 0x3fU))};
}

std::string padded(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

}  // namespace

std::string picture(std::span<const double> positions, std::span<const double> values,
                    const PictureFrame& frame) {
  const std::size_t high = 4 * frame.rows;
  Extent across, up{frame.low, frame.high};
  for (std::size_t i = 0; i < values.size(); ++i) {
    across.add(positions[i]);
    up.add(values[i]);
  }
  std::array<Extent, kWide> columns;
  for (std::size_t i = 0; i < values.size(); ++i)
    columns[across.part(positions[i], kWide)].add(values[i]);

  static constexpr std::array<std::array<unsigned, 4>, 2> kDots{
      {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};
  std::vector<unsigned> cells(kColumns * frame.rows);
  for (std::size_t x = 0; x < kWide; ++x) {
    if (columns[x].is_empty()) continue;
    const std::size_t top = high - 1 - up.part(columns[x].high, high);
    const std::size_t bottom = high - 1 - up.part(columns[x].low, high);
    for (std::size_t y = top; y <= bottom; ++y)
      cells[y / 4 * kColumns + x / 2] |= kDots[x % 2][y % 4];
  }
  constexpr std::size_t kMargin = 11;  // for a number as "-1.234e-05"
  int digits = 4;
  while (digits < 7 && significant(up.low, digits) == significant(up.high, digits)) ++digits;
  std::string text;
  for (std::size_t row = 0; row < frame.rows; ++row) {
    std::string label;
    if (row == 0) label = significant(up.high, digits);
    if (row + 1 == frame.rows) label = significant(up.low, digits);
    text += padded(label, kMargin) + " ";
    for (std::size_t x = 0; x < kColumns; ++x) text += braille(cells[row * kColumns + x]);
    text += '\n';
  }
  const std::string first = significant(across.low, 5), last = significant(across.high, 5);
  return text + std::string(kMargin + 1, ' ') + first + padded(last, kColumns - first.size()) +
         "\n";
}

}  // namespace slideway
