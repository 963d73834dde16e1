#include "kept_values.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/statistics.hpp"
#include "slideway/identify/left_out.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

constexpr double kEven = 0.1;  // relative: no step between values is longer than this
constexpr double kMostOutside =
    0.5;                          // of an orthonormal basis: it stays one of independent columns
constexpr double kGrid = 1024.0;  // places of a station in a step: more is jitter

/// Stations of the low-band values in their median step, for the noise between two of them; empty
/// if they are neighbours. Those closer than the median step count as neighbours; values beyond an
/// end of the trace stand at that end, no step apart.
std::vector<double> stations_of(const Observation& observation) {
  const std::vector<double> positions =
      observation.low_band.positions(observation.profile->positions);
  std::vector<double> steps;
  for (std::size_t i = 1; i < positions.size(); ++i)
    steps.push_back(std::abs(positions[i] - positions[i - 1]));
  if (steps.empty() || std::ranges::max(steps) <= (1.0 + kEven) * std::ranges::min(steps))
    return {};
  std::vector<double> sorted = steps;
  std::erase(sorted, 0.0);
  const double usual = median(sorted);
  std::vector<double> out{0.0};
  for (const double step : steps)
    out.push_back(out.back() + std::max(std::round(kGrid * step / usual) / kGrid, 1.0));
  return out;
}

}  // namespace

LinearProfile kept(LinearProfile profile, const Observation& observation) {
  profile.values = observation.values.size();
  profile.trace = stations_of(observation);
  profile.stations = profile.trace;
  if (observation.left_out() == 0) return profile;
  const std::vector<Eigen::Index> left_out = left_out_values(observation);
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < profile.values; ++i)
    if (!std::ranges::binary_search(left_out, i)) rows.push_back(i);
  if (profile.trace.empty())
    profile.stations.assign(rows.begin(), rows.end());
  else
    std::ranges::transform(rows, profile.stations.begin(),
                           [&](Eigen::Index row) { return profile.trace[row]; });
  profile.stations.resize(rows.size());
  const bool are_independent =
      (profile.nuisances(left_out, Eigen::all).colwise().squaredNorm().array() /
       profile.nuisances.colwise().squaredNorm().array())
          .sum() < kMostOutside;
  profile.nuisances = profile.nuisances(rows, Eigen::all).eval();
  if (!are_independent) profile.nuisances = orthonormal(std::move(profile.nuisances));
  profile.columns = profile.columns(rows, Eigen::all).eval();
  if (profile.bounded.cols() > 0) profile.bounded = profile.bounded(rows, Eigen::all).eval();
  profile.residual = profile.residual(rows).eval();
  return profile;
}

}  // namespace slideway
