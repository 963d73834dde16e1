#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "slideway/identify/noise.hpp"
#include "slideway/signal/octave_powers.hpp"

namespace slideway {

/// What one profile says under a covariance σ² V: its information on (v, w, residual), nuisances
/// eliminated, and ln det V + ln det N' V^-1 N of -2 ln of the restricted likelihood. v are turned
/// so that their information is a diagonal a; with b that between them and (w, residual), and C
/// that of these, they are eliminated at each size by its formulas.
struct ProfileInformation {
  double log_determinants = 0.0;
  double freedom = 0.0;  // values without nuisances

  ProfileInformation(const LinearProfile& profile, const ExponentialMixture& covariance);

  /// Adds what says nothing of (v, w): to the determinants, to the square of the residual and to
  /// the values.
  void add(double log_determinant, double square, double values);

  /// C / σ² - b' diag(1 / (σ² (σ² + a))) b. r + 1 by r + 1
  [[nodiscard]] Eigen::MatrixXd of_shared(double log_size) const;
  /// C - b' diag((2 σ² + a) / (σ² + a)²) b: what (w, residual) and the v that follow from them
  /// leave of the profile, in units of σ².
  [[nodiscard]] Eigen::MatrixXd of_rest(double log_size) const;
  /// Σ a / (σ² + a): degrees of freedom that v takes.
  [[nodiscard]] double taken_by_bounded(double log_size) const;
  /// Σ ln(1 + a / σ²).
  [[nodiscard]] double log_determinant_of_bounded(double log_size) const;

 private:
  Eigen::MatrixXd gram_;     // C
  Eigen::MatrixXd between_;  // b
  Eigen::ArrayXd bounded_;   // a
};

/// A profile that is asked for its information under one covariance after another. Of a long one
/// whose columns are slow, block means stand for the columns.
class ProfileLikelihood {
 public:
  explicit ProfileLikelihood(const LinearProfile& profile);

  [[nodiscard]] const LinearProfile& profile() const { return *profile_; }
  [[nodiscard]] bool is_thinned() const { return thinned_.has_value(); }

  /// The residual is taken as it is.
  [[nodiscard]] ProfileInformation under(const ExponentialMixture& covariance) const;
  /// Without a pass over a long residual, nearly: its block means and OctavePowers.
  [[nodiscard]] ProfileInformation nearly_under(const ExponentialMixture& covariance) const;

 private:
  struct Thinned {
    LinearProfile means;
    OctavePowers faster;
    double block = 1.0;  // values in a mean
  };
  const LinearProfile* profile_;
  std::optional<Thinned> thinned_;
};

/// Sizes σ_i of profiles whose covariances are known but for them, and -2 ln of their restricted
/// likelihood, with a normal prior of ln σ_i about its mean over the profiles.
struct FittedSizes {
  Eigen::VectorXd log_sizes;  // ln σ_i
  Eigen::VectorXd freedom;    // degrees of freedom each was found with
  double cost = 0.0;          // infinite where it cannot be evaluated
};

/// @param rest      r + 1 by r + 1: information of other profiles and of priors
/// @param likeness  standard deviation of the prior
FittedSizes fit_sizes(std::span<const ProfileInformation> profiles, const Eigen::MatrixXd& rest,
                      double likeness, Eigen::VectorXd log_sizes);

/// -2 ln of the restricted likelihood at given sizes; infinite where it cannot be evaluated.
double restricted_cost(std::span<const ProfileInformation> profiles, const Eigen::MatrixXd& rest,
                       const Eigen::VectorXd& log_sizes);

}  // namespace slideway
