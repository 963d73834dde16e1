#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

/// What is expected of (amplitudes, shapes) before a profile is read: a mean, one standard
/// uncertainty in each of some directions, and what is open. No basis: nothing is expected.
struct Expected {
  Eigen::VectorXd mean;
  Eigen::MatrixXd basis, open;
};

/// A profile as predicted by the others: white values and columns, compressed.
class Prediction {
 public:
  Prediction(const ProfileTriangle& triangle, const Expected& expected, double values) {
    if (expected.basis.cols() == 0) return;
    const auto rows = triangle.free();
    const Eigen::Index k = rows.cols() - 1;
    Eigen::MatrixXd known(rows.rows(), expected.basis.cols() + 2);
    known << rows.leftCols(k) * expected.basis, rows.leftCols(k) * expected.mean, rows.col(k);
    const Eigen::MatrixXd open = orthonormal(rows.leftCols(k) * expected.open);
    project_out(open, known);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(known.leftCols(expected.basis.cols()),
                                                Eigen::ComputeThinU);
    inside_ = svd.matrixU().leftCols(svd.rank());
    spread_ = svd.singularValues().head(svd.rank()).cwiseAbs2();
    predicted_ = known.col(known.cols() - 2);
    values_ = known.col(known.cols() - 1);
    count_ = values - static_cast<double>(triangle.levelling() + open.cols());
  }

  [[nodiscard]] Eigen::Index directions() const { return spread_.size(); }

  /// Square of the disagreement in the directions that are predicted.
  [[nodiscard]] double disagreement(double factor) const {
    const Eigen::VectorXd inside = inside_.transpose() * error(factor);
    return (inside.array().square() / (1.0 + spread_.array())).sum();
  }

  /// -2 ln of the likelihood, the noise's size at its best, and that size.
  struct Best {
    double cost = HUGE_VAL, size = 1.0;
  };
  [[nodiscard]] Best best(double factor, double sister_factor) const {
    constexpr int kSizesTried = 800;
    constexpr double kFarthest = 20.0;  // |ln s|: 1e5 of a noise a thousand times too small
    const Eigen::VectorXd e = error(factor);
    const Eigen::ArrayXd inside = (inside_.transpose() * e).array().square();
    const double outside = e.squaredNorm() - inside.sum();
    const double of_unit = 2.0 * count_ * std::log(std::abs(factor));
    Best out;
    for (int step = -kSizesTried; step <= kSizesTried; ++step) {
      const double log_size = kFarthest * step / kSizesTried, size = std::exp(log_size);
      const Eigen::ArrayXd variance = size * size + spread_.array();
      const double unlike = log_size / std::log(sister_factor);
      const double at = (count_ - static_cast<double>(spread_.size())) * 2.0 * log_size +
                        variance.log().sum() + outside / (size * size) + (inside / variance).sum() -
                        of_unit + unlike * unlike;
      if (at < out.cost) out = {at, size};
    }
    return out;
  }

 private:
  [[nodiscard]] Eigen::VectorXd error(double factor) const { return factor * values_ - predicted_; }

  Eigen::MatrixXd inside_;  // orthonormal: what the others predict
  Eigen::VectorXd spread_;  // variance of that prediction
  Eigen::VectorXd predicted_, values_;
  double count_ = 0.0;
};

}  // namespace slideway
