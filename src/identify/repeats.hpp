#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "slideway/identify/agreement.hpp"
#include "slideway/identify/gates.hpp"
#include "slideway/identify/noise.hpp"
#include "slideway/identify/result.hpp"
#include "slideway/identify/solve.hpp"

/// Traces of one surface at one place.
namespace slideway {

/// Stations of the low band, of a face from the spindle axis, mm.
std::vector<double> stations_from_axis(const Observation& observation);

/// Whether two profiles read one cut, wherever on it.
bool are_of_one_surface(const Observation& a, const Observation& b, const Gates& gates);

/// For each low-band value of `a` the one of `b` at the same station, or -1.
std::vector<Eigen::Index> matched_values(const Observation& a, const Observation& b,
                                         const Gates& gates);

/// Whether two profiles read one cut along one line: half of the stations of either are the other's
/// too, within Gates::same_place.
bool are_repeats(const Observation& a, const Observation& b, const Gates& gates);

/// Fitted profiles by index, rising, each with the first group to whose front one it belongs.
template <typename Together>
std::vector<std::vector<std::size_t>> grouped(const Linearisation& linear, Together&& together) {
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const auto own = std::ranges::find_if(out, [&](const std::vector<std::size_t>& group) {
      return together(*linear.observations[group.front()], *linear.observations[i]);
    });
    if (own != out.end())
      own->push_back(i);
    else
      out.push_back({i});
  }
  return out;
}

/// Fitted profiles that repeat one another, two or more in each group, by index, rising.
std::vector<std::vector<std::size_t>> repeat_groups(const Linearisation& linear,
                                                    const Gates& gates);

inline constexpr std::size_t kLeastRepeats = 3;  // of two, either may be the odd one

/// Slow cosines of a vector of each profile, levelled, at the stations all of a group have: a
/// column for each of the group.
Eigen::MatrixXd slow_parts(const Linearisation& linear, const std::vector<Eigen::VectorXd>& of_each,
                           const std::vector<std::size_t>& group, const Gates& gates);

/// One repeat of a group, its slow parts multiplied by a factor, beside the others.
struct RepeatBeside {
  /// What it is off the mean of the others, of the variance that one reading has; then what each of
  /// these is off that mean.
  Eigen::MatrixXd off;

  RepeatBeside(const Eigen::MatrixXd& parts, Eigen::Index which, double factor = 1.0);

  [[nodiscard]] double own() const { return off.col(0).squaredNorm(); }
  [[nodiscard]] double others() const { return off.rightCols(off.cols() - 1).squaredNorm(); }
};

/// Degrees of freedom in each column of deviations, means over octaves of frequency taken for their
/// spectrum: those of a sum of unequal squares (Satterthwaite 1946).
double freedom_of(const Eigen::MatrixXd& deviations);

/// Residual of a profile less the mean of its repeats at the same stations, of the size its noise
/// has; nothing where no other profile repeats it, or where it is odd. Stations that a repeat lacks
/// are left free, and what the columns of `suspect` make, profile by profile.
std::optional<LinearProfile> deviation_from_repeats(
    const Linearisation& linear, std::size_t i, const std::vector<OddRepeat>& odd,
    const Gates& gates, const std::vector<Eigen::MatrixXd>& suspect = {});

}  // namespace slideway
