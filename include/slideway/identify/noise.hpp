#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "slideway/identify/gates.hpp"
#include "slideway/signal/exponential_mixture.hpp"

namespace slideway {

/// The noise of one profile's low band: white noise, texture and long memory.
class Noise {
 public:
  /// One noise the residual allows, and how probable it is.
  struct Alternative {
    double probability = 1.0;
    ExponentialMixture covariance;
  };

  Noise() = default;
  /// Of a trace of n values; mm² or rad².
  /// @param stations  of the values, rising, at least 1 apart; empty: neighbours
  Noise(const ExponentialMixture& covariance, Eigen::Index n, std::vector<double> stations = {});
  /// White noise of a standard deviation, mm or rad.
  static Noise white(double standard_deviation, Eigen::Index n);

  /// The same noise with all variances multiplied.
  [[nodiscard]] Noise scaled(double factor) const;

  /// Factors of the variances of texture and memory, and of white noise.
  struct Weight {
    double memory = 1.0, white = 1.0;
  };
  /// The same noise as one of several readings of one texture weighs by it. m readings that have it
  /// in common say no more of what is slow than one, and each has m times the variance.
  [[nodiscard]] Noise repeated(const Weight& weight) const;

  bool declared = false;   // white, as the problem file has it; else estimated from the residual
  bool overruled = false;  // a declared uncertainty was there, and the residual refutes it
  std::size_t pool = 0;    // profiles with the same one have their memory in common
  double freedom = 0.0;    // degrees of freedom of its size, its memory given
  /// Noises the residual allows, those of one pool in the same order; empty if declared.
  std::vector<Alternative> alternatives;
  /// Size over that of the other profiles of the pool, where it is unlike theirs.
  std::optional<double> unlike_sisters;

  [[nodiscard]] const ExponentialMixture& covariance() const { return covariance_; }
  [[nodiscard]] bool is_estimated() const { return !declared && !alternatives.empty(); }
  [[nodiscard]] bool is_white() const { return covariance_.is_white(); }

  /// That of repeated().
  [[nodiscard]] const Weight& weight() const { return weight_; }

  /// Of one value about the mean of the trace, repeated or not.
  [[nodiscard]] double standard_deviation() const;

  /// Square root of the spectral density at one cycle a trace: the standard deviation of white
  /// noise that would leave smooth parameters as uncertain.
  [[nodiscard]] double long_run_deviation() const;

  /// Variance of the estimate of ln(long-run variance), and the part of it that this profile does
  /// not share with its pool; 0 if declared.
  [[nodiscard]] double log_long_run_variance() const;
  [[nodiscard]] double log_size_variance() const;

  /// Values of white noise that would say as much about smooth parameters.
  [[nodiscard]] double effective_values() const;

  /// Spectral density under another covariance over that under this one, at so many cycles a trace.
  [[nodiscard]] double power_ratio(const ExponentialMixture& other, double cycles) const;

  /// Another covariance at the stations of this trace.
  [[nodiscard]] MixtureFactor factored(const ExponentialMixture& covariance) const;

  /// Adds errors of a known size: C Cᵀ to the covariance, C one standard deviation a column,
  /// #values by k, to those that were added before. Sizes and lengths of the noise are told
  /// without them.
  void add_known(const Eigen::MatrixXd& columns);
  /// C of all that were added; no columns: none.
  [[nodiscard]] Eigen::MatrixXd known() const {
    return known_ ? known_->columns : Eigen::MatrixXd(values_, 0);
  }

  /// Rows made independent with unit variance (whitening), and the inverse. In place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> rows) const;
  void colour(Eigen::Ref<Eigen::MatrixXd> rows) const;

 private:
  /// Known errors in white coordinates: orthonormal directions, and the deviation of each beside
  /// that of the noise.
  struct KnownErrors {
    Eigen::MatrixXd columns, directions;
    Eigen::VectorXd deviations;
  };

  void set_known(const Eigen::MatrixXd& columns);

  [[nodiscard]] double extent() const;  // in stations
  [[nodiscard]] double spectrum(const ExponentialMixture& covariance) const;

  ExponentialMixture covariance_;
  Eigen::Index values_ = 0;
  Weight weight_;
  std::vector<double> stations_;
  std::shared_ptr<const MixtureFactor> factor_;
  std::shared_ptr<const KnownErrors> known_;  // null: none
};

/// One profile, linearised: values ≈ nuisances * ν + columns * w + bounded * v + noise, with the
/// columns reduced to directions all data together determine and v of unit covariance.
struct LinearProfile {
  Eigen::MatrixXd nuisances;       // #values by m
  Eigen::MatrixXd columns;         // #values by r
  Eigen::VectorXd residual;        // at the current estimate
  std::optional<double> declared;  // standard uncertainty of one value, mm or rad
  std::size_t pool = 0;            // profiles with the same one have their memory in common
  std::vector<double> stations;    // rising, at least 1 apart; empty: neighbours
  std::vector<double> trace;       // stations of the whole trace; empty: neighbours
  Eigen::Index values = 0;         // of the whole trace; 0: as many as there are
  Eigen::MatrixXd bounded;         // #values by q, one standard deviation a column, mm or rad

  /// Length of the whole trace in stations.
  [[nodiscard]] double extent() const;
};

/// Estimates the noise of every profile by restricted likelihood (Patterson and Thompson 1971): the
/// parameters of the model are left free, so what the fit has taken out of the residual is allowed
/// for. The covariance of profile i is
///
///   σ_i² (I + g T + h K),  T = exp(-d/L),  K = Σ_k L_k^(α-1) exp(-d/L_k), block means of both,
///
/// scaled so that T and K fall by 1 from the distance 0 to 1: white noise, texture of one length,
/// and a long memory from two values to Gates::longest_memory traces. g, L, h and α are those of
/// all profiles of a pool: no profile alone makes its structure a memory. ln σ_i lies about that of
/// its sisters (Gates::noise_likeness). The result is the most probable place of a lattice of (g,
/// L, h, α); the alternatives are all that are plausible.
///
/// A declared uncertainty stands unless the residual refutes it and has the larger long-run
/// variance.
///
/// @param prior_information  r by r, what priors add to the information on w
std::vector<Noise> estimate_noise(std::span<const LinearProfile> profiles,
                                  const Eigen::MatrixXd& prior_information,
                                  const Gates& gates = {});

}  // namespace slideway
