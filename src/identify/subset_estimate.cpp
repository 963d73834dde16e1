#include "slideway/identify/subset_estimate.hpp"

#include "slideway/identify/identifiability.hpp"

namespace slideway {

SubsetEstimate::SubsetEstimate(const Linearisation& linear, const Compressed& all,
                               std::span<const std::size_t> which, double rank_tolerance) {
  const Eigen::Index k = linear.prior_rows.cols();
  rows.resize(linear.prior_rows.rows(), k + 1);
  rows << linear.prior_rows, linear.prior_residuals;
  Eigen::VectorXd squares = linear.prior_rows.colwise().squaredNorm().transpose();
  for (const std::size_t i : which) {
    Eigen::MatrixXd both(rows.rows() + all.profiles[i].free().rows(), k + 1);
    both << rows, all.profiles[i].free();
    rows = std::move(both);
    squares += all.profiles[i].squares();
  }
  const Rank rank = analyse_rank(rows.leftCols(k), squares.cwiseSqrt(), rank_tolerance);
  basis = rank.basis;
  null_space = rank.null_space;
  change = basis * (basis.transpose() * (rows.leftCols(k).transpose() * rows.col(k)));
}

}  // namespace slideway
