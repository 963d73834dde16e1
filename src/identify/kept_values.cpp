#include "kept_values.hpp"

#include <Eigen/Eigenvalues>
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

/// A basis of what the columns span in the kept rows. Of orthonormal columns Q, with those left out
/// R: Q'Q - R'R has the eigenvalue 0 for what is left out.
Eigen::MatrixXd without_rows(const Eigen::MatrixXd& columns,
                             const std::vector<Eigen::Index>& left_out,
                             const std::vector<Eigen::Index>& rows) {
  constexpr double kOrthonormal = 1e-10, kLeastKept = 0.01;
  const Eigen::Index count = columns.cols();
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(count, count);
  if ((gram_of(columns) - unit).norm() > kOrthonormal)
    return orthonormal(columns(rows, Eigen::all));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> kept(
      unit - gram_of(columns(left_out, Eigen::all)));  // eigenvalues rising
  const Eigen::Index nothing = (kept.eigenvalues().array() < kOrthonormal).count(),
                     little = (kept.eigenvalues().array() < kLeastKept).count();
  if (nothing != little) return orthonormal(columns(rows, Eigen::all));
  return columns(rows, Eigen::all) * kept.eigenvectors().rightCols(count - nothing);
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
  profile.nuisances = without_rows(profile.nuisances, left_out, rows);
  profile.columns = profile.columns(rows, Eigen::all).eval();
  if (profile.bounded.cols() > 0) profile.bounded = profile.bounded(rows, Eigen::all).eval();
  profile.residual = profile.residual(rows).eval();
  return profile;
}

}  // namespace slideway
