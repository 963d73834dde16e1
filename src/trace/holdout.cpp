#include "holdout.hpp"

#include <cmath>

#include "linear_algebra.hpp"

namespace slideway {
namespace {

constexpr double kTold = 5.0;        // standard uncertainties of the effect in the profiles kept
constexpr double kLeastShare = 0.1;  // of what all profiles know of it

/// White columns [model, effect, residual] of one profile, free of its nuisances.
Eigen::MatrixXd white_rows(const Linearisation& linear, const Whitened& data, std::size_t i,
                           const Eigen::MatrixXd& effect) {
  const Observation& observation = *linear.observations[i];
  const Eigen::Index k = linear.prior_rows.cols(), a = effect.cols();
  Eigen::MatrixXd rows(observation.values.size(), k + a + 1);
  rows << linear.columns[i], effect.middleRows(data.first_row(i), data.count(i)),
      linear.residuals[i];
  Eigen::MatrixXd nuisances = observation.nuisances;
  const Noise& noise = data.noise()[i];
  noise.correlation.whiten(rows);
  rows /= noise.innovation;
  if (nuisances.cols() > 0) {
    noise.correlation.whiten(nuisances);
    const Eigen::MatrixXd basis = orthonormal(std::move(nuisances));
    rows -= basis * (basis.transpose() * rows).eval();
  }
  return rows;
}

}  // namespace

std::optional<HeldOut> leave_one_out(const Linearisation& linear, const Whitened& data,
                                     const Refined& candidate) {
  const std::size_t count = linear.observations.size();
  const Eigen::Index k = linear.prior_rows.cols(), a = candidate.columns.cols();
  if (count < 2) return std::nullopt;
  std::vector<Eigen::MatrixXd> rows;
  for (std::size_t i = 0; i < count; ++i)
    rows.push_back(white_rows(linear, data, i, candidate.columns));
  double own_before = 0.0, own_after = 0.0;
  double before = 0.0, after = 0.0, values = 0.0, before_mm = 0.0, after_mm = 0.0, samples = 0.0;
  for (std::size_t left_out = 0; left_out < count; ++left_out) {
    if (rows[left_out].middleCols(k, a).isZero(0.0)) continue;
    Eigen::MatrixXd kept(data.rows() - data.count(left_out), k + a + 1);
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (i == left_out) continue;
      kept.middleRows(next, rows[i].rows()) = rows[i];
      next += rows[i].rows();
    }
    kept.bottomRows(linear.prior_rows.rows()).setZero();
    kept.bottomLeftCorner(linear.prior_rows.rows(), k + a + 1).leftCols(k) = linear.prior_rows;
    kept.bottomRightCorner(linear.prior_rows.rows(), 1) = linear.prior_residuals;
    const LeastSquares without = least_squares(kept.leftCols(k), kept.col(k + a));
    const LeastSquares with = least_squares(kept.leftCols(k + a), kept.col(k + a));
    const double gain = without.square - with.square;
    if (gain < std::max(kTold * kTold, kLeastShare * candidate.projection.gain)) continue;
    const Eigen::VectorXd carried = rows[left_out].middleCols(k, a) * with.values.bottomRows(a);
    if (carried.squaredNorm() < kTold * kTold) continue;
    const Eigen::MatrixXd basis = orthonormal(rows[left_out].leftCols(k));
    Eigen::MatrixXd own(carried.size(), 2);
    own << rows[left_out].col(k + a), carried;
    own -= basis * (basis.transpose() * own).eval();
    if (own.col(1).squaredNorm() >= kTold * kTold) {
      own_before += own.col(0).squaredNorm();
      own_after += (own.col(0) - own.col(1)).squaredNorm();
    }
    const Observation& observation = *linear.observations[left_out];
    Eigen::VectorXd rest_before =
        linear.residuals[left_out] - linear.columns[left_out] * without.values;
    Eigen::VectorXd rest_after =
        linear.residuals[left_out] - linear.columns[left_out] * with.values.topRows(k) -
        candidate.columns.middleRows(data.first_row(left_out), data.count(left_out)) *
            with.values.bottomRows(a);
    if (observation.nuisances.cols() > 0) {
      rest_before -= observation.nuisances * fitted_nuisances(observation, rest_before);
      rest_after -= observation.nuisances * fitted_nuisances(observation, rest_after);
    }
    const double variance = std::pow(data.noise()[left_out].standard_deviation(), 2);
    before += rest_before.squaredNorm() / variance;
    after += rest_after.squaredNorm() / variance;
    values += static_cast<double>(rest_before.size());
    if (observation.profile->setup.quantity != Quantity::height) continue;
    before_mm += rest_before.squaredNorm();
    after_mm += rest_after.squaredNorm();
    samples += static_cast<double>(observation.low_band.samples());
  }
  if (values == 0.0) return std::nullopt;
  HeldOut out{own_before > 0.0 ? own_after < own_before : after < before, {}, {}};
  if (samples > 0.0) {
    out.before_um = std::sqrt(before_mm / samples) / kMicrometre;
    out.after_um = std::sqrt(after_mm / samples) / kMicrometre;
  }
  return out;
}

}  // namespace slideway
