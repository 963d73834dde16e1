#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <system_error>

// Numbers straight from the bytes of a regular row. Nothing here looks for the end of the bytes:
// it gets only lines that end with a newline, and all of it stops there.
namespace slideway {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Passes a sign and returns whether it was a minus. No branch, here and where it is used, because
// the signs of heights are as good as random.
inline std::size_t pass_sign(const char*& at) {
  const std::size_t minus = *at == '-';
  const std::size_t plus = *at == '+';
  at += minus | plus;
  return minus;
}

// Appends the digits at `at` to the mantissa; returns where they end.
inline const char* read_digits(const char* at, std::uint64_t& mantissa) {
  for (; is_digit(*at); ++at) mantissa = mantissa * 10 + static_cast<unsigned>(*at - '0');
  return at;
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

// The number at `at`, correctly rounded; returns where it ends, or nullptr if there is none or it
// has a decimal comma and more digits than a double.
inline const char* read_number(const char* at, const char* end, char decimal, double& value) {
  static constexpr std::array<double, 23> kPowers{1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const char* const start = at;
  const std::size_t minus = pass_sign(at);
  const char* digits = at;
  std::uint64_t mantissa = 0;
  at = read_digits(at, mantissa);
  std::ptrdiff_t count = at - digits;
  std::ptrdiff_t exponent = 0;
  if (*at == decimal) {
    digits = ++at;
    at = read_digits(at, mantissa);
    exponent = digits - at;
    count += at - digits;
  }
  if (count == 0) return nullptr;
  if (*at == 'e' || *at == 'E') at = read_exponent(at + 1, exponent);

  // Both operands are exact doubles, so the one operation rounds correctly (Clinger 1990).
  if (at && count <= 19 && mantissa <= (std::uint64_t{1} << 53U) && exponent >= -22 &&
      exponent <= 22) {
    const auto exact = static_cast<double>(mantissa);
    const double size = exponent < 0 ? exact / kPowers[-exponent] : exact * kPowers[exponent];
    static constexpr std::array<double, 2> kSigns{1.0, -1.0};
    value = size * kSigns[minus];
    return at;
  }
  if (decimal != '.') return nullptr;
  const auto [stop, error] = std::from_chars(start + (*start == '+'), end, value);
  return error == std::errc() ? stop : nullptr;
}

}  // namespace slideway
