#include "noise_bounds.hpp"

#include <algorithm>
#include <cmath>

namespace slideway {
namespace {

constexpr double kRoundingOfValues = 1e-13;  // of the values
constexpr double kSmallestNoise = 1e-17;     // mm or rad: of values that are all zero

}  // namespace

double least_noise(const Profile& profile, const Eigen::VectorXd& values) {
  return std::max(
      {profile.resolution / std::sqrt(12.0), kRoundingOfValues * rms(values), kSmallestNoise});
}

double rms(const Eigen::VectorXd& values) {
  return values.norm() / std::sqrt(static_cast<double>(std::max<Eigen::Index>(values.size(), 1)));
}

bool is_rounding(const Eigen::VectorXd& residual, const Eigen::VectorXd& values) {
  return residual.norm() <= kRoundingOfValues * values.norm();
}

Noise rounding_noise(const Observation& observation, const Eigen::VectorXd& residual,
                     Eigen::Index taken) {
  const Eigen::Index spare = std::max<Eigen::Index>(residual.size() - taken, 1);
  const double size = std::sqrt(residual.squaredNorm() / static_cast<double>(spare));
  const std::optional<double>& declared = observation.profile->standard_uncertainty;
  Noise noise = Noise::white(
      declared.value_or(std::max(size, least_noise(*observation.profile, observation.values))),
      observation.values.size());
  noise.declared = declared.has_value();
  return noise;
}

Noise bounded(const Noise& noise, const Profile& profile, const Eigen::VectorXd& values) {
  if (values.size() == 0) return noise;
  const double least = least_noise(profile, values);
  const double most = std::max(values.maxCoeff() - values.minCoeff(), least);
  const double size = noise.standard_deviation();
  if (size >= least && size <= most) return noise;
  const double possible = size > most ? most : least;
  const double factor = std::pow(possible / size, 2);
  return std::isnormal(factor) ? noise.scaled(factor) : Noise::white(possible, values.size());
}

}  // namespace slideway
