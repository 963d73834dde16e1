#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

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

  /// Standard deviation of white noise that would leave smooth parameters as uncertain as this one
  /// does: sqrt(long-run variance), and never below the innovation's white equivalent.
  [[nodiscard]] double weight_deviation() const;

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

/// Estimates the noise of every profile by restricted maximum likelihood, the parameters of the
/// model left free (so that what the fit has taken out of the residual is put back), AR order by
/// BIC, correlation length up to eight times the trace.
///
/// Correlation is used only where it widens uncertainties: a
/// residual that alternates does not make a smooth parameter better known than white noise would. A
/// declared uncertainty stands unless the residual refutes it (likelihood gain over 10 beyond BIC,
/// and a larger long-run variance).
///
/// @param prior_information  r by r, what priors add to the information on w
std::vector<Noise> estimate_noise(std::span<const LinearProfile> profiles,
                                  const Eigen::MatrixXd& prior_information);

/// columns' Σ columns, where Σ is the noise's covariance matrix.
Eigen::MatrixXd covariance_under(const Noise& noise,
                                 const Eigen::Ref<const Eigen::MatrixXd>& columns);

}  // namespace slideway
