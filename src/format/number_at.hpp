#pragma once

#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>

namespace slideway {

// Parses the number that starts at `first`, correctly rounded, with '.' or ',' as decimal mark and
// an optional sign. Returns its end; nullptr if there is none, or none within the range of double.
inline const char* number_at(const char* first, const char* last, char decimal, double& value) {
  if (first != last && *first == '+' && (++first == last || *first == '-')) return nullptr;
  const fast_float::parse_options options(fast_float::chars_format::general, decimal);
  const auto result = fast_float::from_chars_advanced(first, last, value, options);
  const char* const stop = result.ptr;
  if (result.ec != std::errc() || !std::isfinite(value)) return nullptr;
  const auto is_underflow = [&] {
    const char* const digit = std::find_if(
        first, stop, [](char c) { return (c >= '1' && c <= '9') || c == 'e' || c == 'E'; });
    return digit != stop && *digit <= '9';
  };
  return value == 0.0 && is_underflow() ? nullptr : stop;
}

}  // namespace slideway
