#include "calibration.hpp"

#include <Eigen/Core>
#include <cmath>

#include "slideway/base/random.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr std::uint64_t kNullSeed = 20120712;

/// Which of the noises the residual allows has this share of their probabilities below it.
std::size_t drawn(const std::vector<Noise::Alternative>& alternatives, double share) {
  std::size_t which = 0;
  while (which + 1 < alternatives.size() && share > alternatives[which].probability)
    share -= alternatives[which++].probability;
  return which;
}

/// White rows of one profile become noise: of the drawn memory, and of a size as well known as it
/// is.
void colour(const Noise& noise, const std::vector<double>& shares, const Eigen::VectorXd& normals,
            Eigen::Ref<Eigen::MatrixXd> rows) {
  if (!noise.is_estimated()) return noise.colour(rows);
  std::vector<std::vector<Eigen::Index>> columns(noise.alternatives.size());
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    columns[drawn(noise.alternatives, shares[static_cast<std::size_t>(j)])].push_back(j);
    rows.col(j) *= std::exp(normals[j] / std::sqrt(2.0 * noise.freedom));
  }
  for (std::size_t g = 0; g < columns.size(); ++g) {
    if (columns[g].empty()) continue;
    Eigen::MatrixXd some = rows(Eigen::all, columns[g]);
    noise.factored(noise.alternatives[g].covariance).colour(some);
    rows(Eigen::all, columns[g]) = some;
  }
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
  Eigen::MatrixXd normals(count, static_cast<Eigen::Index>(data.observations()));
  std::vector<double> shares;  // one for all profiles: they share their memory
  for (Eigen::Index j = 0; j < count; ++j) {
    RandomStream random(kNullSeed + static_cast<std::uint64_t>(j), "null");
    for (double& value : out.col(j)) value = random.normal();
    for (double& value : normals.row(j)) value = random.normal();
    shares.push_back(random.uniform());
  }
  for (std::size_t i = 0; i < data.observations(); ++i)
    colour(data.noise()[i], shares, normals.col(static_cast<Eigen::Index>(i)),
           out.middleRows(data.first_row(i), data.count(i)));
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
