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

/// A noise brought between the rounding of the values and their range. Where a fit leaves a profile
/// no value to spare, nothing else keeps the estimate from shrinking or growing without end.
Noise bounded(const Noise& noise, const Eigen::VectorXd& values);

}  // namespace slideway
