#include "slideway/identify/uncertainty.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "residual.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kLarge = 1 << 14;  // low-band values that are worth a second thread
constexpr double kInfinite = 1e6;  // degrees of freedom: above it k is 2, and they are rounding

/// @param covariance  columns' Σ columns
Uncertainty::NoiseEffect noise_effect(const Noise& noise,
                                      const Eigen::Ref<const Eigen::MatrixXd>& columns,
                                      const Eigen::MatrixXd& covariance) {
  constexpr double kStep = 1e-3;  // of atanh π
  Uncertainty::NoiseEffect out{noise.covariance, {}};
  const Eigen::VectorXd at = noise.parameters();
  const auto gram = [&](Eigen::Index j, double step) {
    Eigen::VectorXd moved = at;
    moved[j] += step;
    return covariance_under(noise.at(moved), columns);
  };
  const auto differentiate = [&](std::size_t j) {
    const auto moved = static_cast<Eigen::Index>(j);
    out.derivatives[j] = (gram(moved, kStep) - gram(moved, -kStep)) / (2.0 * kStep);
  };
  const auto correlations = static_cast<std::size_t>(at.size() - 1);
  out.derivatives.resize(correlations + 1);
  if (columns.rows() < kLarge) {
    for (std::size_t j = 0; j < correlations; ++j) differentiate(j);
  } else {
    parallel_for(correlations, differentiate);
  }
  out.derivatives.back() = 2.0 * covariance;  // by ln σ
  return out;
}

/// Variance of ln(weight²) of a profile whose noise was estimated.
double weight_variance(const Noise& noise) {
  constexpr double kStep = 1e-3;
  const Eigen::VectorXd at = noise.parameters();
  Eigen::VectorXd gradient(at.size());
  for (Eigen::Index j = 0; j < at.size(); ++j) {
    Eigen::VectorXd up = at, down = at;
    up[j] += kStep;
    down[j] -= kStep;
    gradient[j] =
        std::log(noise.at(up).weight_deviation() / noise.at(down).weight_deviation()) / kStep;
  }
  return gradient.dot(noise.covariance * gradient);
}

}  // namespace

Spread Uncertainty::of(const Eigen::RowVectorXd& row) const {
  const Eigen::RowVectorXd c = row * basis;
  const double variance = (c * covariance * c.transpose()).value();
  Spread spread{std::sqrt(std::max(variance, 0.0)), std::nullopt};
  double spread_of_variance = 0.0;
  for (const NoiseEffect& effect : noise) {
    Eigen::VectorXd gradient(effect.derivatives.size());
    for (std::size_t j = 0; j < effect.derivatives.size(); ++j)
      gradient[j] = (c * effect.derivatives[j] * c.transpose()).value();
    spread_of_variance += gradient.dot(effect.covariance * gradient);
  }
  const double freedom = 2.0 * variance * variance / spread_of_variance;
  if (spread_of_variance > 0.0 && freedom < kInfinite)
    spread.degrees_of_freedom = std::max(1.0, freedom);
  return spread;
}

Uncertainty assess(const Linearisation& linear, const std::vector<double>& weights,
                   const std::vector<Noise>& noise, const Eigen::MatrixXd& basis) {
  Uncertainty out;
  out.basis = basis;
  const Eigen::MatrixXd priors = linear.prior_rows * basis;
  out.covariance = priors.transpose() * priors;
  std::vector<Eigen::MatrixXd> crosses, gains, own;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    const Eigen::MatrixXd& n = observation.nuisances;
    const Eigen::Index m = n.cols(), r = basis.cols();
    const double square = weights[i] * weights[i];
    Eigen::MatrixXd both(n.rows(), m + r);
    auto k = both.leftCols(m), z = both.rightCols(r);
    if (m > 0) k.noalias() = n * (n.transpose() * n).inverse();
    z.noalias() = linear.columns[i] * (basis / square);
    project_out(linear.nuisance_bases[i], z);
    const Eigen::MatrixXd together = covariance_under(noise[i], both);
    out.covariance += together.bottomRightCorner(r, r);
    if (noise[i].is_estimated()) {
      out.noise.push_back(noise_effect(noise[i], z, together.bottomRightCorner(r, r)));
      const Eigen::MatrixXd share = square * (z.transpose() * z);
      out.covariance += 2.0 * weight_variance(noise[i]) * (share - share * share);
    }
    crosses.emplace_back(together.topRightCorner(m, r));
    gains.emplace_back(k.transpose() * linear.columns[i] * basis);
    own.emplace_back(together.topLeftCorner(m, m));
  }
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const Eigen::MatrixXd cross = crosses[i] * gains[i].transpose();
    out.nuisance_covariances.emplace_back(own[i] - cross - cross.transpose() +
                                          gains[i] * out.covariance * gains[i].transpose());
  }
  return out;
}

double coverage_factor(const std::optional<double>& degrees_of_freedom) {
  constexpr double kOutside = 0.5 * (1.0 - 0.954499736103642);  // beyond two standard deviations
  if (!degrees_of_freedom) return 2.0;
  return student_limit(*degrees_of_freedom, kOutside);
}

}  // namespace slideway
