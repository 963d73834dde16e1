#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/solve.hpp"

namespace slideway {

/// A linearised model by where its columns act. What acts in one profile alone and has no prior is
/// free there, as the levelling is. What has priors of its own there is an error of known size
/// about their values. The cost of all else grows with what profiles share.
struct ColumnPlaces {
  std::vector<Eigen::MatrixXd> free;       // per observation: its columns that are free
  std::vector<Eigen::MatrixXd> bounded;    // per observation: one standard deviation a column
  std::vector<Eigen::VectorXd> residuals;  // per observation: at the values of these priors
  std::vector<Eigen::Index> own;           // columns of the model that are in these
  std::vector<Eigen::Index> shared;        // all others
  std::vector<Eigen::Index> priors;        // rows of priors of those

  explicit ColumnPlaces(const Linearisation& linear);
};

}  // namespace slideway
