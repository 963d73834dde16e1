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

/// Model, and model with effect, fitted to the rows of all profiles but one.
struct OtherProfiles {
  LeastSquares without, with;

  OtherProfiles(const Linearisation& linear, const std::vector<Eigen::MatrixXd>& rows,
                std::size_t left_out) {
    const Eigen::Index k = linear.prior_rows.cols(), priors = linear.prior_rows.rows();
    const Eigen::Index last = rows[0].cols() - 1;
    Eigen::Index count = priors;
    for (std::size_t i = 0; i < rows.size(); ++i) count += i == left_out ? 0 : rows[i].rows();
    Eigen::MatrixXd kept = Eigen::MatrixXd::Zero(count, last + 1);
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (i == left_out) continue;
      kept.middleRows(next, rows[i].rows()) = rows[i];
      next += rows[i].rows();
    }
    kept.bottomLeftCorner(priors, k) = linear.prior_rows;
    kept.bottomRightCorner(priors, 1) = linear.prior_residuals;
    without = least_squares(kept.leftCols(k), kept.col(last));
    with = least_squares(kept.leftCols(last), kept.col(last));
  }

  [[nodiscard]] double gain() const { return without.square - with.square; }
};

/// A square summed over the profiles left out, as predicted without and with the effect.
struct PredictionError {
  double before = 0.0, after = 0.0;

  void add(const Eigen::VectorXd& without, const Eigen::VectorXd& with) {
    before += without.squaredNorm();
    after += with.squaredNorm();
  }
  [[nodiscard]] bool falls() const { return after < before; }
};

/// Prediction of a profile's low band, its own levelling allowed: what is left of the residual.
Eigen::VectorXd left_over(const Observation& observation, Eigen::VectorXd rest) {
  if (observation.nuisances.cols() > 0)
    rest -= observation.nuisances * fitted_nuisances(observation, rest);
  return rest;
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
  PredictionError beyond_model, white, heights;
  double samples = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto model = rows[i].leftCols(k), effect = rows[i].middleCols(k, a);
    if (effect.isZero(0.0)) continue;
    const OtherProfiles others(linear, rows, i);
    if (others.gain() < std::max(kTold * kTold, kLeastShare * candidate.projection.gain)) continue;
    const Eigen::VectorXd amplitudes = others.with.values.bottomRows(a);
    const Eigen::VectorXd carried = effect * amplitudes;
    if (carried.squaredNorm() < kTold * kTold) continue;
    const Eigen::VectorXd residual = rows[i].col(k + a);
    white.add(residual - model * others.without.values,
              residual - model * others.with.values.topRows(k) - carried);
    const Eigen::MatrixXd basis = orthonormal(model);
    const auto outside = [&](const Eigen::VectorXd& column) -> Eigen::VectorXd {
      return column - basis * (basis.transpose() * column);
    };
    if (outside(carried).squaredNorm() >= kTold * kTold)
      beyond_model.add(outside(residual), outside(residual - carried));
    const Observation& observation = *linear.observations[i];
    if (observation.profile->setup.quantity != Quantity::height) continue;
    const auto own = candidate.columns.middleRows(data.first_row(i), data.count(i));
    heights.add(
        left_over(observation, linear.residuals[i] - linear.columns[i] * others.without.values),
        left_over(observation, linear.residuals[i] -
                                   linear.columns[i] * others.with.values.topRows(k) -
                                   own * amplitudes));
    samples += static_cast<double>(observation.low_band.samples());
  }
  if (white.before == 0.0) return std::nullopt;
  HeldOut out{beyond_model.before > 0.0 ? beyond_model.falls() : white.falls(), {}, {}};
  if (samples > 0.0) {
    out.before_um = std::sqrt(heights.before / samples) / kMicrometre;
    out.after_um = std::sqrt(heights.after / samples) / kMicrometre;
  }
  return out;
}

}  // namespace slideway
