#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace slideway {

/// Stationary AR(p) noise, e_t = Σ_j φ_j e_(t-j) + u_t, given by its partial autocorrelations
/// (each in (-1, 1): stationary by construction; Durbin-Levinson recursion).
class Autoregression {
 public:
  explicit Autoregression(std::vector<double> partial_autocorrelations = {});

  [[nodiscard]] int order() const { return static_cast<int>(partial_.size()); }
  [[nodiscard]] const std::vector<double>& partial_autocorrelations() const { return partial_; }

  /// φ of the predictor of order m from the m samples before, m <= order().
  [[nodiscard]] std::span<const double> predictor(int m) const;

  /// Variance of the prediction error of order m over that of order p: 1 for m = p.
  [[nodiscard]] double relative_variance(int m) const;

  /// Var(e_t) / Var(u_t).
  [[nodiscard]] double variance_ratio() const { return relative_variance(0); }

  /// Autocorrelation ρ_0 ... ρ_max_lag.
  [[nodiscard]] std::vector<double> autocorrelation(int max_lag) const;

  /// Long-run variance over Var(e): Σ of ρ over all lags. The mean of n samples has the variance
  /// Var(e) / n times this ratio.
  [[nodiscard]] double long_run_ratio() const;

  /// Whitens rows in place: row t minus its prediction from earlier rows, divided by
  /// sqrt(relative_variance). The result is independent with the variance of u, also in the first
  /// rows.
  void whiten(Eigen::Ref<Eigen::MatrixXd> rows) const;

  /// The inverse of whiten(), in place: independent rows become this noise.
  void colour(Eigen::Ref<Eigen::MatrixXd> rows) const;

  /// ln det of the correlation structure: Σ_t ln(relative_variance) over n rows.
  [[nodiscard]] double log_determinant(Eigen::Index n) const;

  /// Partial autocorrelations of a series about zero up to order p (Burg's method; a mean is not
  /// removed); each clipped to ±0.995.
  static std::vector<double> burg(std::span<const double> series, int p);

 private:
  std::vector<double> partial_;
  std::vector<std::vector<double>> predictors_;  // [m] has m entries
  std::vector<double> relative_variance_;        // [m]
};

/// Ljung-Box p-value of a series for whiteness over `lags` lags, `fitted` parameters subtracted.
double ljung_box_p_value(std::span<const double> series, int lags, int fitted);

}  // namespace slideway
