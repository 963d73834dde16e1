#pragma once

#include <cstddef>
#include <type_traits>

namespace slideway {

// Calls loop(N), N being the number of taps as a constant where it is one of the common ones, which
// a compiler makes a faster loop of, else 0.
template <typename Loop>
void with_known_taps(std::ptrdiff_t taps, const Loop& loop) {
  switch (taps) {
    case 2:
      return loop(std::integral_constant<std::ptrdiff_t, 2>());
    case 4:
      return loop(std::integral_constant<std::ptrdiff_t, 4>());
    case 6:
      return loop(std::integral_constant<std::ptrdiff_t, 6>());
    case 8:
      return loop(std::integral_constant<std::ptrdiff_t, 8>());
    default:
      return loop(std::integral_constant<std::ptrdiff_t, 0>());
  }
}

}  // namespace slideway
