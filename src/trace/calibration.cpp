#include "calibration.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr std::uint64_t kSeed = 20120712;

/// Noise parameters as their estimate's covariance has them.
Noise drawn(const Noise& noise, double most_spread, RandomStream& random) {
  if (!noise.is_estimated()) return noise;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(noise.covariance);
  Eigen::VectorXd deviation(noise.covariance.rows());
  for (double& value : deviation) value = random.normal();
  const Eigen::VectorXd spread =
      eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().cwiseMin(most_spread);
  return noise.at(noise.parameters() + eigen.eigenvectors() * spread.cwiseProduct(deviation));
}

}  // namespace

double Calibration::p_value(double penalised_gain) const {
  return -std::expm1(-std::exp(-(penalised_gain - location) / scale));
}

double Calibration::threshold(double significance) const {
  return location - scale * std::log(-std::log1p(-significance));
}

Eigen::MatrixXd null_residuals(const Whitened& data, const Gates& gates) {
  const auto count = static_cast<Eigen::Index>(gates.resamples);
  Eigen::MatrixXd out(data.rows(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    RandomStream random(kSeed + static_cast<std::uint64_t>(j), "null");
    for (double& value : out.col(j)) value = random.normal();
    for (std::size_t i = 0; i < data.observations(); ++i) {
      const Noise noise = drawn(data.noise()[i], gates.resample_spread, random);
      auto rows = out.block(data.first_row(i), j, data.count(i), 1);
      noise.colour(rows);
    }
  }
  return data.outside(std::move(out));
}

Calibration calibrate(const Whitened& data, const Candidates& candidates, const Gates& gates,
                      const std::function<void(double)>& progress) {
  const auto resamples = static_cast<Eigen::Index>(gates.resamples);
  const Eigen::VectorXd gains =
      largest_gains(data, candidates, null_residuals(data, gates), progress);
  constexpr double kEuler = 0.5772156649015329;
  const double mean = gains.mean();
  const double variance =
      (gains.array() - mean).square().sum() / static_cast<double>(resamples - 1);
  Calibration out;
  out.scale = std::max(std::sqrt(6.0 * variance) / kPi, 1e-6);
  out.location = mean - kEuler * out.scale;
  return out;
}

}  // namespace slideway
