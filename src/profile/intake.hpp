#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slideway/base/units.hpp"
#include "slideway/profile/profile.hpp"

namespace slideway {

// What turns numbers of the file into ours.
struct Conversion {
  UnitScale position, value;  // to mm, or s where positions are times; to mm or rad
  UnitScale to_mm;            // of a position that is a time
  UnitScale time;             // to s, of a reading time
  std::optional<std::pair<double, double>> window;  // in the file's unit
  std::vector<std::pair<double, double>> mask;      // in the file's unit

  [[nodiscard]] bool is_masked(double given) const {
    return std::ranges::any_of(
        mask, [&](const auto& part) { return given >= part.first && given <= part.second; });
  }
};

// Samples converted together, as most are: none missing, outside the window or out of order.
class PlainSamples {
 public:
  static constexpr std::size_t kCount = 1024;

  // False if one of them is not plain. `last` is the position before them.
  bool convert(const Conversion& convert, std::span<const double> positions,
               std::span<const double> values, double last, bool upwards);

  [[nodiscard]] std::span<const double> positions() const { return positions_; }
  [[nodiscard]] std::span<const double> values() const { return values_; }

 private:
  using Samples = std::array<double, kCount>;
  static void scaled(const UnitScale& scale, const double* from, Samples& to);

  Samples positions_, values_;
};

// The points of a file on their way into a profile, in the file's order: those inside the window
// that have a value and are not left out, in our units, as means where they are too many.
class Intake {
 public:
  // REQUIRES both to live as long.
  Intake(const ProfileSource& source, Profile& profile);

  void take(const TracePart& part);
  // Turns a trace that runs backwards and tells the profile's notes what was done.
  void finish();
  // Data row of a sample of the profile, the first of those it is the mean of.
  [[nodiscard]] std::size_t row(std::size_t sample) const;
  // Smallest and largest position, of points without a value and left out too, mm.
  [[nodiscard]] std::pair<double, double> reach() const;

 private:
  using Run = std::pair<std::size_t, std::size_t>;  // its first sample and that one's row

  void start(const TracePart& part);
  void take_one(double given, double value, std::span<const double> time);
  void pass_over(double given);
  void keep(std::span<const double> positions, std::span<const double> values,
            std::span<const double> times, std::size_t first_row);
  void keep_mean(double position, double value, std::span<const double> time);
  void halve();
  void check_left_out() const;

  const ProfileSource* source_;
  Profile* profile_;
  std::optional<Conversion> convert_;
  std::vector<std::size_t> left_out_rows_;  // ascending
  PlainSamples plain_;
  std::size_t rows_ = 0, kept_ = 0;          // of the file; before means were taken
  std::size_t masked_ = 0;                   // samples
  std::vector<Run> runs_;                    // kept samples whose rows follow one another
  double last_given_ = 0.0, last_mm_ = 0.0;  // positions
  std::pair<double, double> passed_over_{INFINITY, -INFINITY};  // smallest and largest of them, mm
  bool upwards_ = true;
  std::size_t block_ = 1, pending_ = 0;  // samples of a mean; of the one at hand
  double position_sum_ = 0.0, value_sum_ = 0.0, time_sum_ = 0.0;  // of that
  std::vector<double> times_;  // of the profile's samples, s; empty without a time column
};

}  // namespace slideway
