#include "slideway/identify/uncertainty.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slideway/base/distribution.hpp"
#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kLarge = 1 << 14;  // low-band values that are worth a second thread
constexpr double kInfinite = 1e6;  // degrees of freedom: above it k is 2, and they are rounding

/// Information of one profile on w under another noise, its nuisances eliminated.
Eigen::MatrixXd information_under(const Noise& noise, const Observation& observation,
                                  const Eigen::MatrixXd& columns) {
  const Eigen::Index m = observation.nuisances.cols(), r = columns.cols();
  Eigen::MatrixXd rows(columns.rows(), m + r);
  rows << observation.nuisances, columns;
  noise.whiten(rows);
  Eigen::MatrixXd gram = rows.transpose() * rows;
  if (m == 0) return gram;
  const Eigen::MatrixXd cross = gram.topRightCorner(m, r);
  return gram.bottomRightCorner(r, r) -
         cross.transpose() *
             gram.topLeftCorner(m, m).completeOrthogonalDecomposition().solve(cross);
}

/// How the covariance of w moves with the noise of one profile: against the information.
Uncertainty::NoiseEffect noise_effect(const Noise& noise, const Observation& observation,
                                      const Eigen::MatrixXd& columns,
                                      const Eigen::MatrixXd& information) {
  constexpr double kStep = 1e-3;  // of atanh π
  Uncertainty::NoiseEffect out;
  out.covariance = noise.covariance;
  const Eigen::VectorXd at = noise.parameters();
  const auto count = static_cast<std::size_t>(at.size() - 1);
  out.derivatives.resize(count + 1);
  const auto differentiate = [&](std::size_t j) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(at.size(), std::ptrdiff_t(j));
    out.derivatives[j] = (information_under(noise.at(at - step), observation, columns) -
                          information_under(noise.at(at + step), observation, columns)) /
                         (2.0 * kStep);
  };
  if (columns.rows() < kLarge) {
    for (std::size_t j = 0; j < count; ++j) differentiate(j);
  } else {
    parallel_for(count, differentiate);
  }
  out.derivatives.back() = 2.0 * information;  // by ln σ
  const auto n = static_cast<double>(columns.rows());
  const double effective = n / std::min(noise.correlation.long_run_ratio(), n);
  out.degrees_of_freedom = std::max(1.0, effective - information.trace());
  return out;
}

}  // namespace

Spread Uncertainty::of(const Eigen::RowVectorXd& row) const {
  const Eigen::RowVectorXd c = row * basis;
  const double variance = (c * covariance * c.transpose()).value();
  Spread spread{std::sqrt(std::max(inflation * variance, 0.0)), std::nullopt};
  double spread_of_variance = 0.0;
  for (const NoiseEffect& effect : noise) {
    Eigen::VectorXd gradient(effect.derivatives.size());
    for (std::size_t j = 0; j < effect.derivatives.size(); ++j)
      gradient[j] = (c * effect.derivatives[j] * c.transpose()).value();
    const double share = (c * information[effect.observation] * c.transpose()).value();
    spread_of_variance += std::max(gradient.dot(effect.covariance * gradient),
                                   2.0 * share * share / effect.degrees_of_freedom);
  }
  const double freedom = 2.0 * variance * variance / spread_of_variance;
  if (spread_of_variance > 0.0 && freedom < kInfinite)
    spread.degrees_of_freedom = std::max(1.0, freedom);
  return spread;
}

void Uncertainty::add(const Eigen::MatrixXd& more, const Compressed& compressed) {
  const Eigen::MatrixXd to_basis =
      basis.transpose() * compressed.triangle.transpose() * compressed.triangle;
  covariance += to_basis * more * to_basis.transpose() / inflation;
}

Uncertainty assess(const Linearisation& linear, const Compressed& compressed,
                   const std::vector<Noise>& noise, const Eigen::MatrixXd& basis,
                   double inflation) {
  const Eigen::Index r = basis.cols();
  Uncertainty out;
  out.inflation = inflation;
  out.basis = basis;
  out.covariance = Eigen::MatrixXd::Identity(r, r);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const ProfileTriangle& profile = compressed.profiles[i];
    const Eigen::MatrixXd rows = profile.free().leftCols(profile.columns()) * basis;
    const Eigen::MatrixXd& information = out.information.emplace_back(rows.transpose() * rows);
    if (!noise[i].is_estimated()) continue;
    out.noise.push_back(
        noise_effect(noise[i], *linear.observations[i], linear.columns[i] * basis, information));
    out.noise.back().observation = i;
    out.covariance +=
        2.0 * noise[i].log_long_run_variance() * (information - information * information);
  }
  const Eigen::MatrixXd of_columns = basis * out.covariance * basis.transpose();
  for (const ProfileTriangle& profile : compressed.profiles)
    out.nuisance_covariances.emplace_back(inflation * profile.levelling_covariance(of_columns));
  return out;
}

double coverage_factor(const std::optional<double>& degrees_of_freedom) {
  constexpr double kOutside = 0.5 * (1.0 - 0.954499736103642);  // beyond two standard deviations
  if (!degrees_of_freedom) return 2.0;
  return student_limit(*degrees_of_freedom, kOutside);
}

}  // namespace slideway
