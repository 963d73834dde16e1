#pragma once

#include <Eigen/Core>

namespace slideway {

/// Length of the path of unit vectors that a curve's rows are on, each up to its sign.
/// @param rows      n by m, whose products are the covariance of the curve
/// @param variance  of each of its n points
/// @param least     points of no more variance are left out
double path_length(const Eigen::MatrixXd& rows, const Eigen::VectorXd& variance, double least);

/// Factor that the standardised deviation of a curve exceeds somewhere with a given probability
/// (tube formula: Sun and Loader 1994, Eq. 2.3).
/// @param length   path_length() of the curve
/// @param freedom  of the noise; infinite where it is known
/// @param outside  probability in (0, 1)
double simultaneous_factor(double length, double freedom, double outside);

}  // namespace slideway
