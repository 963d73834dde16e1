#include "slideway/base/random.hpp"

#include <cmath>

namespace slideway {
namespace {

// FNV-1a, 64 bits (Fowler, Noll, Vo).
std::uint64_t hash(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325U;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return value;
}

// The finaliser of SplitMix64 (Steele, Lea, Flood 2014): near inputs get unrelated outputs.
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15U;
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

// ln(x) of a normal x > 0 by 2 artanh((m - 1) / (m + 1)), sqrt(1/2) <= m < sqrt(2). Made of IEEE
// operations only, because the last digit of a library's logarithm differs between machines.
double logarithm(double x) {
  constexpr double kLn2 = 0.693147180559945309417232121458176568;
  constexpr double kSqrtHalf = 0.707106781186547524400844362104849039;
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < kSqrtHalf) {
    mantissa *= 2.0;
    --exponent;
  }
  const double t = (mantissa - 1.0) / (mantissa + 1.0);  // |t| < 0.172
  double sum = 0.0;
  for (int power = 23; power >= 1; power -= 2) sum = sum * t * t + 1.0 / power;
  return exponent * kLn2 + 2.0 * t * sum;
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name)
    : engine_(mixed(mixed(seed) ^ hash(name))) {}

double RandomStream::uniform() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  for (;;) {
    const double u = 2.0 * uniform() - 1.0;
    const double v = 2.0 * uniform() - 1.0;
    const double square = u * u + v * v;
    if (square >= 1.0 || square == 0.0) continue;
    const double scale = std::sqrt(-2.0 * logarithm(square) / square);
    spare_ = v * scale;
    has_spare_ = true;
    return u * scale;
  }
}

}  // namespace slideway
