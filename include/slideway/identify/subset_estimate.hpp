#pragma once

#include <Eigen/Core>
#include <span>

#include "slideway/identify/solve.hpp"

namespace slideway {

/// What some of the fitted profiles, with the priors, say of (amplitudes, shapes) by themselves.
struct SubsetEstimate {
  Eigen::MatrixXd rows;               // [columns, residual], white and compressed
  Eigen::VectorXd scale;              // of the columns, before levelling took its part of them
  Eigen::MatrixXd basis, null_space;  // as Rank has them
  Eigen::VectorXd change;             // of the joint estimate; 0 where they say nothing

  /// @param all    of the same linearisation
  /// @param which  indices of fitted profiles
  SubsetEstimate(const Linearisation& linear, const Compressed& all,
                 std::span<const std::size_t> which, double rank_tolerance);
};

/// Least squares of rows [columns, residual]. What of a column is below `rank_tolerance` of its
/// scale is the rounding of what was taken out of it.
struct DataFit {
  Eigen::MatrixXd rows;  // a triangle that has the same products
  double left = 0.0;     // of the residual's square
  Eigen::Index rank = 0;

  DataFit() = default;
  DataFit(const Eigen::MatrixXd& data, const Eigen::VectorXd& scale, double rank_tolerance);
};

}  // namespace slideway
