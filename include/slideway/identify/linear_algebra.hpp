#pragma once

#include <Eigen/Core>

namespace slideway {

/// Orthonormal basis of what the columns span; columns are judged by their direction, not size.
Eigen::MatrixXd orthonormal(Eigen::MatrixXd columns);

/// Takes what an orthonormal basis Q spans out of columns C, in place: C - Q Q'C.
template <typename Basis, typename Columns>
void project_out(const Eigen::MatrixBase<Basis>& basis, Eigen::MatrixBase<Columns>& columns) {
  columns.noalias() -= basis.derived() * (basis.transpose() * columns.derived()).eval();
}

/// Sets columns to zero that are less than 1e-9 of what they were: the rounding of what was taken
/// out of them is no direction.
/// @param before  their lengths
void clear_rounding(Eigen::Ref<Eigen::MatrixXd> columns, const Eigen::VectorXd& before);

/// Puts more columns, of as many rows, behind the others.
void append_columns(Eigen::MatrixXd& columns, const Eigen::MatrixXd& more);

struct LeastSquares {
  Eigen::MatrixXd values;   // one column per target, of least size where the columns leave a choice
  Eigen::VectorXd squares;  // of what is left of each target
};
LeastSquares least_squares(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& targets);

/// C'C of the columns C.
Eigen::MatrixXd gram_of(const Eigen::MatrixXd& columns);

/// Upper triangular, at most as many rows as columns, with the same inner products of its columns.
Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& columns);

/// (C'C)⁺: covariance of the amplitudes of the columns C, for white data of unit variance.
Eigen::MatrixXd amplitude_covariance(const Eigen::MatrixXd& columns);

}  // namespace slideway
