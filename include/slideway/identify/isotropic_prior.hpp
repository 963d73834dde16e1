#pragma once

#include <Eigen/Core>
#include <vector>

namespace slideway {

/// Coefficients with a normal prior of mean 0 and covariance v I, and data of unit variance that
/// have the information A on them and the products q with them (Rasmussen and Williams 2006, 2.3).
///
/// A = B - SᵀS: B of blocks down its diagonal, S of few rows that couple them. B is made
/// tridiagonal once; every v then takes O(count) (Woodbury's identity).
class IsotropicPrior {
 public:
  /// @param information  A, symmetric and positive semidefinite
  IsotropicPrior(const Eigen::MatrixXd& information, const Eigen::VectorXd& products);

  /// @param blocks  of B, each symmetric and positive semidefinite
  /// @param shared  S, as many columns as the blocks have
  IsotropicPrior(const std::vector<Eigen::MatrixXd>& blocks, const Eigen::MatrixXd& shared,
                 const Eigen::VectorXd& products);

  /// Log of the likelihood under v over that under 0:
  ///   (v qᵀ (I + v A)⁻¹ q - ln det (I + v A)) / 2;
  /// -infinity where v is so large that rounding decides it.
  [[nodiscard]] double log_evidence(double variance) const;

  /// Mean given the data: v (I + v A)⁻¹ q.
  [[nodiscard]] Eigen::VectorXd mean(double variance) const;

 private:
  struct Elimination;
  [[nodiscard]] Elimination eliminated(double variance) const;

  std::vector<Eigen::MatrixXd> axes_;  // of each block: axes (tridiagonal) axesᵀ
  Eigen::ArrayXd diagonal_, beside_;
  Eigen::MatrixXd targets_;  // q and Sᵀ, side by side, on the axes
};

}  // namespace slideway
