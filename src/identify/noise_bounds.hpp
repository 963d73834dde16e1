#pragma once

#include <Eigen/Core>

#include "slideway/identify/model.hpp"
#include "slideway/identify/noise.hpp"

namespace slideway {

double rms(const Eigen::VectorXd& values);

/// Whether a residual of these values is only rounding.
bool is_rounding(const Eigen::VectorXd& residual, const Eigen::VectorXd& values);

/// White, of the size of a residual that is only rounding.
/// @param taken  how many parameters have taken part of it
Noise rounding_noise(const Observation& observation, const Eigen::VectorXd& residual,
                     Eigen::Index taken);

/// The least noise that a profile can have: that of rounding to the resolution of its readings, a
/// rectangular distribution (GUM F.2.2.1), or to a double; never 0.
double least_noise(const Profile& profile, const Eigen::VectorXd& values);

/// A noise brought between least_noise() and the range of the values. Where a fit leaves a profile
/// no value to spare, nothing else keeps the estimate from shrinking or growing without end.
Noise bounded(const Noise& noise, const Profile& profile, const Eigen::VectorXd& values);

}  // namespace slideway
