#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/noise.hpp"
#include "slideway/signal/lagged_products.hpp"

namespace slideway {

/// Largest |atanh π|: |π| < 0.9999; a hum sampled finely comes close to 1.
inline constexpr double kLargestAtanh = 5.0;

/// Correlation of the noise with parameters (atanh π_1 ... atanh π_p, ln innovation).
Autoregression correlation_of(const Eigen::VectorXd& parameters);

/// Whitened cross products of a matrix of columns for any AR noise, from the lagged products of the
/// columns: the cost of one evaluation does not depend on the number of rows.
class WhitenedProducts {
 public:
  WhitenedProducts(const ColumnParts& columns, int max_order);

  /// columns' R^-1 columns, R the correlation structure with unit innovations.
  [[nodiscard]] Eigen::MatrixXd under(const Autoregression& noise) const;

 private:
  Eigen::MatrixXd head_;
  std::vector<std::vector<Eigen::MatrixXd>> products_;
};

/// -2 ln of the restricted likelihood as a function of one profile's noise, the noise of the others
/// fixed (Patterson and Thompson 1971): with V the covariance of the values and X all columns,
///   ln det V + ln det X' V^-1 X + residual' P residual.
class RestrictedLikelihood {
 public:
  RestrictedLikelihood(const LinearProfile& profile, int max_order);

  /// Information that this profile gives on (w, residual), nuisances eliminated.
  /// @param cost  not null: is given the part of the likelihood that is this profile's own
  [[nodiscard]] Eigen::MatrixXd information(const Eigen::VectorXd& parameters, double* cost) const;

  /// @param rest  information of all other profiles and the priors on (w, residual)
  /// @return infinity where it cannot be evaluated
  [[nodiscard]] double operator()(const Eigen::VectorXd& parameters,
                                  const Eigen::MatrixXd& rest) const;

 private:
  Eigen::Index n_, m_, r_;
  WhitenedProducts products_;
};

}  // namespace slideway
