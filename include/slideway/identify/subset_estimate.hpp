#pragma once

#include <Eigen/Core>
#include <span>

#include "slideway/identify/solve.hpp"

namespace slideway {

/// What some of the fitted profiles, with the priors, say of (amplitudes, shapes) by themselves.
struct SubsetEstimate {
  Eigen::MatrixXd rows;               // [columns, residual], white and compressed
  Eigen::MatrixXd basis, null_space;  // as Rank has them
  Eigen::VectorXd change;             // of the joint estimate; 0 where they say nothing

  /// @param all    of the same linearisation
  /// @param which  indices of fitted profiles
  SubsetEstimate(const Linearisation& linear, const Compressed& all,
                 std::span<const std::size_t> which, double rank_tolerance);
};

}  // namespace slideway
