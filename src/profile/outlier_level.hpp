#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace slideway {

inline constexpr std::size_t kPart = 1 << 16;      // samples looked at by one thread at a time
inline constexpr std::size_t kScaleFrom = 2048;    // errors: the scale of more is that of a part
inline constexpr double kMad = 1.482602218505602;  // normal deviation over its median size

// A profile or its means, and how a value follows from its neighbours: from those `lag` to either
// side (second difference), or by a cubic from those 2 lag away as well (fourth difference).
struct Level {
  std::span<const double> samples;    // positions
  std::span<const double> positions;  // of the means, where they are not uniform
  std::span<const double> values;
  std::size_t block = 1;  // samples in a mean
  std::size_t lag = 1;
  bool cubic = true;
  bool uniform = true;
  double widest = 0.0;  // step that is no gap

  std::vector<double> errors;  // about their median; 0 where not judged
  double middle = 0.0, scale = 0.0;
  double rounding = 0.0;  // standard deviation of what rounding makes of an error

  [[nodiscard]] std::size_t outermost() const { return cubic ? 2 * lag : lag; }
  // Errors that far away know nothing of a value and its next ones.
  [[nodiscard]] std::size_t touched() const { return cubic ? 3 * lag - 1 : lag; }
  [[nodiscard]] double position(std::size_t j) const {
    return uniform ? 0.5 * (samples[j * block] + samples[(j + 1) * block - 1]) : positions[j];
  }
  [[nodiscard]] bool judged(std::size_t i) const;
  [[nodiscard]] double error(std::size_t i) const {
    return uniform ? even_error(i) : uneven_error(i);
  }
  [[nodiscard]] double even_error(std::size_t i) const {
    const auto d = static_cast<std::ptrdiff_t>(lag);
    return cubic ? cubic_error(&values[i], d) : linear_error(&values[i], d);
  }
  static double cubic_error(const double* z, std::ptrdiff_t d) {
    return z[0] - (2.0 / 3.0) * (z[-d] + z[d]) + (1.0 / 6.0) * (z[-2 * d] + z[2 * d]);
  }
  static double linear_error(const double* z, std::ptrdiff_t d) {
    return z[0] - 0.5 * (z[-d] + z[d]);
  }
  [[nodiscard]] double uneven_error(std::size_t i) const;
  void find_scale();
  void find_scale(std::size_t size, const std::function<double(std::size_t)>& error_of);
  void find_errors();
  [[nodiscard]] std::uint64_t count_above(double least, std::size_t from, std::size_t to) const;
  [[nodiscard]] bool any_above(double least) const;
  [[nodiscard]] double scale_of(std::vector<double>& part) const;
  [[nodiscard]] double scale_at(std::size_t i, double limit) const;
  [[nodiscard]] double peak_of_structure() const;
  [[nodiscard]] bool missed_from_either_side(std::size_t i, double error) const;
};

}  // namespace slideway
