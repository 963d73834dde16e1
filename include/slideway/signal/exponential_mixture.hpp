#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

namespace slideway {

/// Stationary noise of several memories at once: white noise, and noises whose autocorrelation
/// decays exponentially (Ornstein-Uhlenbeck). A value is the mean over a block of length 1, so the
/// covariance of two values at a distance d is
///
///   w + Σ_k v_k 2 L_k (1 - L_k (1 - exp(-1/L_k)))     d = 0
///   Σ_k v_k (2 L_k sinh(1 / (2 L_k)))² exp(-d/L_k)    d >= 1
///
/// Lengths and distances are in low-band values, variances in the square of the values' unit.
/// Lengths a constant factor apart with v_k = L_k^(α-1) make noise with a spectrum near f^-α.
struct ExponentialMixture {
  static constexpr int kTerms = 7;
  using Terms = Eigen::Array<double, kTerms, 1>;

  double white = 1.0;               // w
  Terms lengths = Terms::Ones();    // L_k
  Terms variances = Terms::Zero();  // v_k

  [[nodiscard]] bool is_white() const { return (variances == 0.0).all(); }
  [[nodiscard]] double variance() const;
  [[nodiscard]] double covariance(double distance) const;  // REQUIRES distance >= 1

  /// Variance of the mean of n neighbours.
  [[nodiscard]] double variance_of_mean(double n) const;

  /// The noise of means over so many neighbours, its lengths in such means.
  [[nodiscard]] ExponentialMixture of_means(double neighbours) const;

  /// Of each term, its part of the covariance continued to the distance 0.
  [[nodiscard]] Terms continued() const;

  /// Spectral density: Σ of the covariance over all distances times cos(2π f d).
  [[nodiscard]] double spectrum(double cycles_per_value) const;

  /// Lengths from the first to the last, a constant factor apart.
  static Terms spread_lengths(double first, double last);
};

/// The covariance of n values as L D L', L unit lower triangular: in O(n), for a sum of
/// exponentials is semiseparable (Foreman-Mackey et al. 2017, Astron. J. 154:220, Eqs. 31-48).
class MixtureFactor {
 public:
  /// Values at neighbouring places.
  MixtureFactor(const ExponentialMixture& noise, Eigen::Index n);

  /// @param stations  rising, at least 1 apart; what lies in a gap is no value
  MixtureFactor(const ExponentialMixture& noise, std::span<const double> stations);

  [[nodiscard]] Eigen::Index rows() const { return deviation_.size(); }

  /// Rows made independent with unit variance, (L sqrt(D))^-1 rows, and the inverse. In place.
  /// REQUIRES rows() rows.
  void whiten(Eigen::Ref<Eigen::MatrixXd> rows) const;
  void colour(Eigen::Ref<Eigen::MatrixXd> rows) const;

  [[nodiscard]] double log_determinant() const;

 private:
  enum class Direction { whiten, colour };
  using Terms = ExponentialMixture::Terms;

  void factorise(const ExponentialMixture& noise, const std::vector<double>& steps);
  void set_decays(const Terms& rates, const std::vector<double>& steps);
  [[nodiscard]] const Terms& decay(Eigen::Index row) const {
    return decays_[decay_of_.empty() ? 0 : decay_of_[static_cast<std::size_t>(row)]];
  }
  template <int Count>
  void factorise(double variance, const Terms& amplitudes);
  template <int Count, int Columns, Direction direction>
  void filter(double* first, Eigen::Index stride) const;
  template <int Count, Direction direction>
  void filter(Eigen::Ref<Eigen::MatrixXd> rows) const;
  template <Direction direction>
  void filter_all(Eigen::Ref<Eigen::MatrixXd> rows) const;

  int count_ = 0;                        // of terms: 0, 1 or all
  std::vector<Terms> decays_;            // over each step between neighbours that occurs
  std::vector<std::uint32_t> decay_of_;  // which of them leads to a value; empty: the only one
  std::vector<double> gains_;            // count_ per value, times the amplitudes
  Eigen::ArrayXd deviation_;             // sqrt(D)
};

}  // namespace slideway
