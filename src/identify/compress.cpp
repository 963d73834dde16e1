#include <Eigen/Dense>
#include <algorithm>

#include "slideway/identify/solve.hpp"

namespace slideway {
namespace {

/// Upper triangle of a tall matrix fed in blocks of rows: each block is folded into the triangle of
/// those before it, so memory does not grow with the rows.
class TallQr {
 public:
  explicit TallQr(Eigen::Index columns) : triangle_(Eigen::MatrixXd::Zero(columns, columns)) {}

  void add(const Eigen::Ref<const Eigen::MatrixXd>& rows) {
    constexpr Eigen::Index kBlockRows = 512;  // that stay in the cache
    const Eigen::Index k = triangle_.cols();
    for (Eigen::Index first = 0; first < rows.rows(); first += kBlockRows) {
      const Eigen::Index count = std::min(kBlockRows, rows.rows() - first);
      work_.resize(k + count, k);
      work_ << triangle_, rows.middleRows(first, count);
      const Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(work_);
      triangle_ = work_.topRows(k).triangularView<Eigen::Upper>();
    }
  }

  [[nodiscard]] const Eigen::MatrixXd& triangle() const { return triangle_; }

 private:
  Eigen::MatrixXd triangle_, work_;
};

}  // namespace

ProfileTriangle::ProfileTriangle(const Observation& observation, const Noise& noise,
                                 const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual)
    : levelling_(std::ssize(observation.nuisance_names)) {
  const Eigen::Index left_out = observation.left_out();
  Eigen::MatrixXd rows(residual.size(), left_out + levelling_ + columns.cols() + 1);
  rows << observation.nuisances.rightCols(left_out), observation.nuisances.leftCols(levelling_),
      columns, residual;
  noise.whiten(rows);
  TallQr qr(rows.cols());
  qr.add(rows);
  const Eigen::Index rest = rows.cols() - left_out;
  upper_ = qr.triangle().bottomRightCorner(rest, rest);
  squares_ = qr.triangle()
                 .rightCols(columns.cols() + 1)
                 .leftCols(columns.cols())
                 .colwise()
                 .squaredNorm()
                 .transpose();
}

Eigen::MatrixXd ProfileTriangle::levelling_inverse() const {
  if (levelling_ == 0) return Eigen::MatrixXd(0, 0);
  const Eigen::MatrixXd own =
      upper_.topLeftCorner(levelling_, levelling_).triangularView<Eigen::Upper>();
  return own.completeOrthogonalDecomposition()
      .pseudoInverse();  // two readings know no third number
}

Eigen::VectorXd ProfileTriangle::levelled(const Eigen::VectorXd& change) const {
  return levelling_inverse() * (upper_.topRightCorner(levelling_, 1).col(0) -
                                upper_.block(0, levelling_, levelling_, columns()) * change);
}

Eigen::MatrixXd ProfileTriangle::levelling_covariance(const Eigen::MatrixXd& of_columns) const {
  const Eigen::MatrixXd inverse = levelling_inverse();
  const Eigen::MatrixXd carried = inverse * upper_.block(0, levelling_, levelling_, columns());
  return inverse * inverse.transpose() + carried * of_columns * carried.transpose();
}

Compressed compress(const Linearisation& linear, const std::vector<Noise>& noise) {
  const Eigen::Index k = linear.prior_rows.cols(), priors = linear.prior_rows.rows();
  Compressed out;
  TallQr qr(k + 1);
  Eigen::MatrixXd prior_rows(priors, k + 1);
  prior_rows << linear.prior_rows, linear.prior_residuals;
  qr.add(prior_rows);
  Eigen::VectorXd squares = linear.prior_rows.colwise().squaredNorm().transpose();
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    out.profiles.emplace_back(*linear.observations[i], noise[i], linear.columns[i],
                              linear.residuals[i]);
    qr.add(out.profiles.back().free());
    squares += out.profiles.back().squares();
  }
  out.triangle = qr.triangle().topLeftCorner(k, k);
  out.target = qr.triangle().topRightCorner(k, 1);
  out.scale = squares.cwiseSqrt();
  return out;
}

}  // namespace slideway
