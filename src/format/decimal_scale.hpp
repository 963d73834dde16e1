#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace slideway {

// Decimal exponents that are scaled here.
inline constexpr std::ptrdiff_t kLeastScale = -27, kLargestScale = 27;

// The first 128 bits of 5^q, the highest one set; below one rounded up.
struct PowerOfFive {
  std::uint64_t high = 0, low = 0;
};

constexpr PowerOfFive power_of_five(std::ptrdiff_t q) {
  std::uint64_t power = 1;
  for (std::ptrdiff_t i = 0; i < (q < 0 ? -q : q); ++i) power *= 5;
  if (q >= 0) return {power << std::countl_zero(power), 0};
  // 2^(127 + bits of the power) / power, bit by bit: a quotient of 128 bits.
  PowerOfFive out;
  std::uint64_t rest = 1;
  for (int bit = 127 + static_cast<int>(std::bit_width(power)); bit > 0; --bit) {
    rest *= 2;
    out.high = (out.high << 1U) | (out.low >> 63U);
    out.low = (out.low << 1U) | (rest >= power ? 1U : 0U);
    if (rest >= power) rest -= power;
  }
  out.high += ++out.low == 0 ? 1U : 0U;
  return out;
}

// mantissa * 10^exponent, correctly rounded, by the first bits of a product (Eisel and Lemire:
// Lemire 2021, Software: Practice and Experience 51, 1700). REQUIRES an exponent within the limits.
inline double scaled(std::uint64_t mantissa, std::ptrdiff_t exponent) {
  static constexpr auto kPowers = [] {
    std::array<PowerOfFive, kLargestScale - kLeastScale + 1> powers;
    for (std::size_t i = 0; i < powers.size(); ++i)
      powers[i] = power_of_five(static_cast<std::ptrdiff_t>(i) + kLeastScale);
    return powers;
  }();
  __extension__ using Wide = unsigned __int128;
  constexpr int kDigits = 53, kBias = 1023;
  if (mantissa == 0) return 0.0;
  const int zeros = std::countl_zero(mantissa);
  const std::uint64_t number = mantissa << static_cast<unsigned>(zeros);
  const PowerOfFive& power = kPowers[static_cast<std::size_t>(exponent - kLeastScale)];
  Wide product = static_cast<Wide>(number) * power.high;
  constexpr std::uint64_t kBeyond = ~std::uint64_t{0} >> (kDigits + 2);
  if ((static_cast<std::uint64_t>(product >> 64U) & kBeyond) == kBeyond)  // a carry may reach it
    product += (static_cast<Wide>(number) * power.low) >> 64U;
  const auto high = static_cast<std::uint64_t>(product >> 64U);
  const auto low = static_cast<std::uint64_t>(product);
  const auto top = static_cast<unsigned>(high >> 63U);
  const unsigned shift = top + 64 - (kDigits + 2);
  std::uint64_t digits = high >> shift;  // and one more, by which it is rounded
  // Exactly between two numbers: to the even one.
  if (low <= 1 && exponent >= -4 && exponent <= 23 && (digits & 3U) == 1U &&
      digits << shift == high)
    digits &= ~std::uint64_t{1};
  digits = (digits + (digits & 1U)) >> 1U;
  // floor(log2(10^q)) = floor(217706 q / 2^16) here.
  auto binary = static_cast<std::int64_t>((217706 * exponent) >> 16) + 63 + static_cast<int>(top) -
                zeros + kBias;
  if (digits >> kDigits != 0) {
    digits >>= 1U;
    ++binary;
  }
  constexpr std::uint64_t kFraction = (std::uint64_t{1} << (kDigits - 1)) - 1;
  return std::bit_cast<double>((static_cast<std::uint64_t>(binary) << (kDigits - 1)) |
                               (digits & kFraction));
}

}  // namespace slideway
