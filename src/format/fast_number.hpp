#pragma once

#include <array>
#include <bit>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <system_error>

#include "decimal_scale.hpp"

// Numbers straight from the bytes of a regular row. Nothing here looks for the end of the bytes:
// it gets only lines that end with a newline, and all of it stops there.
namespace slideway {

// Up to here the doubles hold every integer, and every power of ten.
inline constexpr std::uint64_t kLargestExact = std::uint64_t{1} << 53U;
inline constexpr std::array<double, 23> kPowersOfTen{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                     1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                     1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
inline constexpr std::array<double, 2> kSigns{1.0, -1.0};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Passes a sign and returns whether it was a minus. No branch, here and where it is used, because
// the signs of heights are as good as random.
inline std::size_t pass_sign(const char*& at) {
  const std::size_t minus = *at == '-';
  const std::size_t plus = *at == '+';
  at += minus | plus;
  return minus;
}

// Eight digits, the first in the lowest byte, each 0 to 9, by three multiplications (Lemire).
inline std::uint64_t eight_digits(std::uint64_t digits) {
  constexpr std::uint64_t kPairs = 0x000000ff000000ffU;
  digits = digits * 10 + (digits >> 8U);
  return (((digits & kPairs) * (100 + (std::uint64_t{1'000'000} << 32U))) +
          (((digits >> 16U) & kPairs) * (1 + (std::uint64_t{10'000} << 32U)))) >>
         32U;
}

struct Digits {
  std::uint64_t mantissa = 0;
  std::ptrdiff_t exponent = 0, count = 0;  // mantissa * 10^exponent; zeros in front count
};

// Eight bytes, the first in the lowest, digits as their values.
inline std::uint64_t word_at(const char* at) {
  std::uint64_t word = 0;
  std::memcpy(&word, at, 8);
  return word ^ 0x3030303030303030U;
}

inline unsigned leading_digits(std::uint64_t word) {
  const std::uint64_t others = (word | (word + 0x7676767676767676U)) & 0x8080808080808080U;
  return static_cast<unsigned>(std::countr_zero(others)) / 8;  // 8 if there are none
}

// Appends `count` < 8 digits of a word.
inline std::uint64_t appended(std::uint64_t mantissa, std::uint64_t word, unsigned count) {
  static constexpr std::array<std::uint64_t, 8> kTens{1,      10,      100,       1'000,
                                                      10'000, 100'000, 1'000'000, 10'000'000};
  return mantissa * kTens[count] + eight_digits((word << 8U) << (56U - 8U * count));
}

[[gnu::noinline]] inline const char* read_digits_singly(const char* at, char decimal, Digits& out) {
  out = {};
  const char* mark = nullptr;
  for (; is_digit(*at) || (*at == decimal && mark == nullptr); ++at) {
    if (*at == decimal)
      mark = at;
    else
      out.mantissa = out.mantissa * 10 + static_cast<unsigned>(*at - '0'), ++out.count;
  }
  if (mark != nullptr) out.exponent = mark + 1 - at;
  return at;
}

// Reads digits with or without a decimal mark; returns where they end. Eight bytes at a time, as
// many of them as are digits: their number is as good as random too.
inline const char* read_digits(const char* at, const char* end, char decimal, Digits& out) {
  if (std::endian::native != std::endian::little || end - at < 25)
    return read_digits_singly(at, decimal, out);
  std::uint64_t word = word_at(at);
  const unsigned before = leading_digits(word);
  if (before == 8) return read_digits_singly(at, decimal, out);
  if (at[before] != decimal) {
    out = {appended(0, word, before), 0, before};
    return at + before;
  }
  const std::uint64_t whole = (std::uint64_t{1} << (8 * before)) - 1;
  word = (word & whole) | (word_at(at + 1) & ~whole);  // without the mark
  unsigned count = leading_digits(word), last = count;
  if (last < 8) {
    out.mantissa = appended(0, word, last);
  } else {
    out.mantissa = eight_digits(word);
    word = word_at(at + 9);
    last = leading_digits(word);
    if (last == 8) {
      out.mantissa = out.mantissa * 100'000'000 + eight_digits(word);
      word = word_at(at + 17);
      last = leading_digits(word);
      if (last == 8) return read_digits_singly(at, decimal, out);
      count += 8;
    }
    out.mantissa = appended(out.mantissa, word, last);
    count += last;
  }
  out.count = count;
  out.exponent = static_cast<std::ptrdiff_t>(before) - out.count;
  return at + count + 1;
}

// Reads the exponent after 'e' or 'E' and adds it; returns where it ends, or nullptr if it is none
// or needs more than four digits.
inline const char* read_exponent(const char* at, std::ptrdiff_t& exponent) {
  const bool negative = pass_sign(at) == 1;
  const char* const digits = at;
  std::ptrdiff_t value = 0;
  for (; is_digit(*at) && at - digits < 5; ++at) value = value * 10 + (*at - '0');
  if (at == digits || at - digits > 4) return nullptr;
  exponent += negative ? -value : value;
  return at;
}

inline const char* read_any_number(const char* start, const char* end, char decimal,
                                   double& value) {
  if (decimal != '.') return nullptr;
  const auto [stop, error] = std::from_chars(start + (*start == '+'), end, value);
  return error == std::errc() ? stop : nullptr;
}

// A number of more digits than a double has exactly, which goes from text[0] to text[1].
[[gnu::noinline]] inline const char* read_long_number(std::array<const char*, 2> text,
                                                      Digits digits, const char* end, char decimal,
                                                      double& value) {
  const bool minus = *text[0] == '-';
  const char* zero = text[0] + (minus || *text[0] == '+');
  for (; digits.count > 19 && (*zero == '0' || *zero == decimal); ++zero)
    digits.count -= *zero == '0';
  if (digits.count > 19 || digits.exponent < kLeastScale || digits.exponent > kLargestScale)
    return read_any_number(text[0], end, decimal, value);
  value = scaled(digits.mantissa, digits.exponent) * kSigns[minus ? 1 : 0];
  return text[1];
}

// The number at `at`, correctly rounded; returns where it ends, or nullptr if there is none or it
// has a decimal comma and more digits than are read here.
inline const char* read_number(const char* at, const char* end, char decimal, double& value) {
  const char* const start = at;
  const std::size_t minus = pass_sign(at);
  Digits digits;
  at = read_digits(at, end, decimal, digits);
  auto& [mantissa, exponent, count] = digits;
  if (count == 0) return nullptr;
  if (*at == 'e' || *at == 'E') at = read_exponent(at + 1, exponent);
  // Both operands are exact doubles, so the one operation rounds correctly (Clinger 1990).
  if (at && count <= 19 && mantissa <= kLargestExact && exponent >= -22 && exponent <= 22)
      [[likely]] {
    const auto exact = static_cast<double>(mantissa);
    value = (exponent < 0 ? exact / kPowersOfTen[-exponent] : exact * kPowersOfTen[exponent]) *
            kSigns[minus];
    return at;
  }
  return at ? read_long_number({start, at}, digits, end, decimal, value)
            : read_any_number(start, end, decimal, value);
}

}  // namespace slideway
