#pragma once

#include <cstdint>
#include <random>
#include <string_view>

namespace slideway {

/// A reproducible stream of random numbers: the same (seed, name) gives the same numbers on every
/// machine (std::mt19937_64 is specified bit by bit, and the normal deviates are made here).
/// Streams of different names are independent.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Uniform on [0, 1), 53 bits.
  double uniform();

  /// Standard normal deviate (Marsaglia's polar method).
  double normal();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace slideway
