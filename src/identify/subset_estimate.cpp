#include "slideway/identify/subset_estimate.hpp"

#include <utility>

#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/linear_algebra.hpp"

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
  scale = squares.cwiseSqrt();
  const Rank rank = analyse_rank(rows.leftCols(k), scale, rank_tolerance);
  basis = rank.basis;
  null_space = rank.null_space;
  change = basis * (basis.transpose() * (rows.leftCols(k).transpose() * rows.col(k)));
}

DataFit::DataFit(const Eigen::MatrixXd& data, const Eigen::VectorXd& scale, double rank_tolerance)
    : rows(upper_triangle(data)) {
  const Eigen::Index k = rows.cols() - 1;
  const Eigen::MatrixXd basis = analyse_rank(rows.leftCols(k), scale, rank_tolerance).basis;
  const Eigen::MatrixXd spanned = rows.leftCols(k) * basis;
  left = (rows.col(k) - spanned * (spanned.transpose() * rows.col(k))).squaredNorm();
  rank = basis.cols();
}

}  // namespace slideway
