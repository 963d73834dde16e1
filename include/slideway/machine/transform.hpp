#pragma once

#include <Eigen/Core>

namespace slideway {

/// Homogeneous transform, 4 by 4. T_AB turns coordinates in frame B into coordinates in frame A;
/// products read by adjacency: T_AB * T_BC.
using Transform = Eigen::Matrix4d;

/// The six degrees of freedom of one body against its lower body: translations in mm, rotations in
/// rad about X, Y, Z (the paper's alpha, beta, gamma).
struct ErrorMotion {
  double x = 0.0, y = 0.0, z = 0.0;
  double alpha = 0.0, beta = 0.0, gamma = 0.0;
};

/// R_x(alpha) R_y(beta) R_z(gamma) T(x, y, z), exact, as printed in Eq. (2).
Transform exact_transform(const ErrorMotion& motion);

/// First order of Eq. (2), the matrices of Eq. (4).
Transform first_order_transform(const ErrorMotion& motion);

/// Pure translation, mm.
Transform translation(double x, double y, double z);

}  // namespace slideway
