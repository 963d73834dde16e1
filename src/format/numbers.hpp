#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Numbers as the standard formats spell them; every DataError starts with `place`.
namespace slideway {

/// Words of a text, separated by blanks, line ends and NUL.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  std::optional<std::string_view> next();

 private:
  std::string_view text_;
};

std::vector<std::string_view> words(std::string_view text);

/// The line a text starts with, without its end; the text then starts after it.
std::string_view take_line(std::string_view& text);

/// @throws DataError unless the field spells a finite number
double read_number(std::string_view field, const std::string& place);

/// @throws DataError unless the field spells a number above 0
double read_positive(std::string_view field, const std::string& place);

/// @throws DataError unless the field spells a whole number from 1 to 2^53, as an integer or 1e3
std::size_t read_count(std::string_view field, const std::string& place);

/// Exactly `count` finite numbers; each word of `missing` is a missing point, NaN.
std::vector<double> read_numbers(std::string_view text, std::size_t count, const std::string& place,
                                 std::span<const std::string_view> missing = {});

/// @throws DataError where a product is no finite number
void multiply(std::span<double> values, double scale, const std::string& place);

/// @throws DataError if `bytes` cannot hold so many values of at least `size` bytes each
void check_count(std::size_t count, std::size_t bytes, std::size_t size, const std::string& place);

/// A number stored with its lowest byte first, at the start of the bytes.
template <typename Number>
Number little_endian(std::string_view bytes) {
  std::uint64_t bits = 0;
  for (std::size_t i = sizeof(Number); i-- > 0;)
    bits = (bits << 8U) | static_cast<unsigned char>(bytes[i]);
  Number number;
  if constexpr (sizeof(Number) == 8) {
    std::memcpy(&number, &bits, 8);
  } else if constexpr (sizeof(Number) == 4) {
    const auto low = static_cast<std::uint32_t>(bits);
    std::memcpy(&number, &low, 4);
  } else {
    number = static_cast<Number>(bits);
  }
  return number;
}

/// The eight bytes of a double, the lowest first.
void append_little_endian(std::string& bytes, double value);

}  // namespace slideway
