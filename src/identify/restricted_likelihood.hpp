#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slideway/identify/noise.hpp"

namespace slideway {

/// What one profile says under a covariance: its information on (w, residual), nuisances
/// eliminated, and ln det V + ln det N' V^-1 N of -2 ln of the restricted likelihood.
struct ProfileInformation {
  Eigen::MatrixXd gram;  // r + 1 by r + 1
  double log_determinants = 0.0;
  double freedom = 0.0;  // values without nuisances

  ProfileInformation(const LinearProfile& profile, const ExponentialMixture& covariance);
};

/// Sizes σ_i of profiles whose covariances are known but for them, and -2 ln of their restricted
/// likelihood, with a normal prior of ln σ_i about its mean over the profiles.
struct FittedSizes {
  Eigen::VectorXd log_sizes;  // ln σ_i
  Eigen::VectorXd freedom;    // degrees of freedom each was found with
  double cost = 0.0;          // infinite where it cannot be evaluated
};

/// @param rest      r + 1 by r + 1: information of other profiles and of priors
/// @param likeness  standard deviation of the prior
FittedSizes fit_sizes(std::span<const ProfileInformation> profiles, const Eigen::MatrixXd& rest,
                      double likeness, Eigen::VectorXd log_sizes);

/// -2 ln of the restricted likelihood at given sizes; infinite where it cannot be evaluated.
double restricted_cost(std::span<const ProfileInformation> profiles, const Eigen::MatrixXd& rest,
                       const Eigen::VectorXd& log_sizes);

}  // namespace slideway
