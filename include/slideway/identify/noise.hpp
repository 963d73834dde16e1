#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "slideway/identify/gates.hpp"
#include "slideway/signal/autoregression.hpp"

namespace slideway {

/// The noise of one profile's low band: AR(p) with innovations of standard deviation `innovation`.
struct Noise {
  Autoregression correlation;
  double innovation = 1.0;  // mm or rad, of one low-band value
  bool declared = false;    // white, as the problem file has it; else estimated from the residual
  bool overruled = false;   // a declared uncertainty was there, and the residual refutes it
  Eigen::MatrixXd covariance;  // of (atanh π_1 ... atanh π_p, ln innovation); empty if declared,
                               // 0 across a limit they stand at

  [[nodiscard]] bool is_estimated() const { return !declared && covariance.size() > 0; }
  [[nodiscard]] double standard_deviation() const;

  /// Square root of the long-run variance: the standard deviation of white noise that would leave
  /// smooth parameters as uncertain.
  [[nodiscard]] double long_run_deviation() const;

  /// Variance of the estimate of ln(long-run variance); 0 if declared.
  [[nodiscard]] double log_long_run_variance() const;

  /// Rows made independent with unit variance (whitening), and the inverse. In place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> rows) const;
  void colour(Eigen::Ref<Eigen::MatrixXd> rows) const;

  /// The noise with the same declared flags at other parameters of `covariance`'s kind.
  [[nodiscard]] Noise at(const Eigen::VectorXd& parameters) const;
  [[nodiscard]] Eigen::VectorXd parameters() const;
};

/// One profile, linearised: values ≈ nuisances * ν + columns * w + noise, with the columns reduced
/// to directions all data together determine.
struct LinearProfile {
  Eigen::MatrixXd nuisances;       // #values by 0 ... 2
  Eigen::MatrixXd columns;         // #values by r
  Eigen::VectorXd residual;        // at the current estimate
  std::optional<double> declared;  // standard uncertainty of one value, mm or rad
  int least_order = 0;             // of the autoregression, whatever BIC says
};

/// Estimates the noise of every profile by restricted maximum likelihood: the parameters of the
/// model are left free, so what the fit has taken out of the residual is allowed for. The order of
/// the autoregression is that of the least BIC.
///
/// If the long-run variance is below the variance, white noise of that variance is used: a residual
/// that alternates does not make a smooth parameter better known. A declared uncertainty stands
/// unless the residual refutes it and has the larger long-run variance.
///
/// @param prior_information  r by r, what priors add to the information on w
std::vector<Noise> estimate_noise(std::span<const LinearProfile> profiles,
                                  const Eigen::MatrixXd& prior_information,
                                  const Gates& gates = {});

}  // namespace slideway
