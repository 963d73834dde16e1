#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "slideway/profile/profile.hpp"

namespace slideway {

/// What one line reads at a place where it meets others, against what all the others say; mm.
struct Misclosure {
  std::size_t profile = 0;
  std::array<double, 2> place{};
  std::optional<double> difference;  // from the mean of the other heights there, as the data stand
  std::optional<double> size;        // of the closure; none: nothing checks this reading
  std::optional<double> standard_uncertainty;  // of `size`; none: too few stations tell the scatter
};

/// Two profiles of one line, and the station at which they differ most from an offset and a tilt;
/// mm.
struct Repeat {
  std::size_t a = 0, b = 0;  // profiles
  std::size_t stations = 0;  // compared
  std::array<double, 2> place{};
  double difference = 0.0;            // of b from a there, as all other stations have it
  double standard_uncertainty = 0.0;  // of that, by the scatter of the others
  double limit = 0.0;                 // of their ratio

  [[nodiscard]] bool is_beyond() const {
    return std::abs(difference) > limit * standard_uncertainty;
  }
};

struct Closure {
  std::size_t lines = 0, places = 0;
  std::size_t redundancy = 0;         // closures that do not follow from one another
  bool tied = false;                  // the heights agree wherever lines meet: made to agree
  std::optional<double> limit;        // of |size| in standard uncertainties
  std::vector<Misclosure> readings;   // by place
  std::optional<std::size_t> worst;   // of `readings`: the one furthest beyond the limit, if any
                                      // is; of several the one that shows it most precisely
  std::vector<std::size_t> suspects;  // profiles without any one of which the rest closes
  std::vector<Repeat> repeats;
  std::vector<std::string> notes;  // on profiles not used, or whose place looks wrong
};

inline constexpr double kClosureFalseAlarm = 1e-3;  // per set of lines, and per repeated line

/// Closes the lines of a surface: do the heights of profiles agree where their lines cross or meet?
///
/// Lines of one z_mm that are not parallel meet where they intersect, ends and half a station
/// beyond them included. A height profile is read there by its values, a slope profile by the sum
/// of slope times step. Nobody knows a line's offset and tilt, nor the surface's heights h, so
///   reading(line, place) = h(place) + offset(line) + tilt(line) t + error
/// is solved by least squares, weighted by the scatter of the stations along the lines. `size` is
/// the error that one reading would need to have for all to close (Baarda's data snooping); where
/// one closure is left, it is what opening the loop at that reading shows.
///
/// Scatter: the MAD of second differences (find_outliers()), of all lines of fewer than 200
/// stations and the same quantity together, of a longer line alone; `standard_uncertainty` where
/// given. It adds up along the line as a random walk: slopes always; heights of fewer than 200
/// stations, which were stepped, and longer ones whose scatter grows with the lag. Roughness of the
/// surface counts as scatter. The limit holds the largest of all readings below it in 1 -
/// kClosureFalseAlarm of sets.
///
/// Heights that are the same wherever lines meet come from a reduction which moved those stations.
/// Then (`tied`) a line's reading at a place is what its stations beside it say.
///
/// Two profiles with the same ends, either way round, are compared at each station of the coarser
/// one; 6 stations at least. What surface and scatter do to both drops out, so that one wrong
/// station shows. The ratio is Student's t of the deleted residual, the limit Bonferroni's.
///
/// Nothing if fewer than two profiles say where they lie.
std::optional<Closure> close_lines(const std::vector<Profile>& profiles);

}  // namespace slideway
