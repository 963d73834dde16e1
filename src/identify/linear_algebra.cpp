#include "slideway/identify/linear_algebra.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <utility>

namespace slideway {
namespace {

constexpr double kRankTolerance = 1e-10;  // of a unit column

Eigen::VectorXd to_unit(const Eigen::MatrixXd& columns) {
  return columns.colwise().norm().transpose().unaryExpr(
      [](double norm) { return norm > 0.0 ? 1.0 / norm : 0.0; });
}

}  // namespace

Eigen::MatrixXd gram_of(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns.cols(), columns.cols());
  gram.selfadjointView<Eigen::Lower>().rankUpdate(columns.transpose());
  gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
  return gram;
}

Eigen::MatrixXd orthonormal(Eigen::MatrixXd columns) {
  if (columns.size() == 0) return Eigen::MatrixXd(columns.rows(), 0);
  columns *= to_unit(columns).asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(kRankTolerance);
  qr.compute(columns);
  return qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
}

void clear_rounding(Eigen::Ref<Eigen::MatrixXd> columns, const Eigen::VectorXd& before) {
  constexpr double kRounding = 1e-9;
  for (Eigen::Index j = 0; j < columns.cols(); ++j)
    if (columns.col(j).norm() <= kRounding * before[j]) columns.col(j).setZero();
}

void append_columns(Eigen::MatrixXd& columns, const Eigen::MatrixXd& more) {
  Eigen::MatrixXd out(std::max(columns.rows(), more.rows()), columns.cols() + more.cols());
  out << columns, more;
  columns = std::move(out);
}

LeastSquares least_squares(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& targets) {
  if (columns.cols() == 0)
    return {Eigen::MatrixXd(0, targets.cols()), targets.colwise().squaredNorm()};
  const Eigen::VectorXd unit = to_unit(columns);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kRankTolerance);
  solver.compute(columns * unit.asDiagonal());
  LeastSquares out;
  const Eigen::MatrixXd scaled = solver.solve(targets);
  out.values = unit.asDiagonal() * scaled;
  out.squares = (targets - columns * out.values).colwise().squaredNorm();
  return out;
}

Eigen::MatrixXd upper_triangle(const Eigen::MatrixXd& columns) {
  const Eigen::Index size = std::min(columns.rows(), columns.cols());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  return qr.matrixQR().topRows(size).triangularView<Eigen::Upper>();
}

Eigen::MatrixXd amplitude_covariance(const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd inverse =
      upper_triangle(columns).completeOrthogonalDecomposition().pseudoInverse();
  return inverse * inverse.transpose();
}

}  // namespace slideway
