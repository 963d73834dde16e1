#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "slideway/identify/noise.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

/// Standard uncertainty of one number and the degrees of freedom it was found with (none: known).
struct Spread {
  double standard_uncertainty = 0.0;
  std::optional<double> degrees_of_freedom;
};

/// Uncertainty of a least-squares estimate under correlated noise.
///
/// The estimate is w = Σ_i Z_i' (values_i - ...) / weight_i² in orthonormal coordinates; its
/// covariance is Σ_i Z_i' Σ_i Z_i / weight_i⁴ plus the priors' part, with Σ_i the noise of profile
/// i: weights that do not fit the noise cost efficiency, never honesty. Weights taken from the data
/// add 2 Σ_i var(ln weight_i²) (G_i - G_i²), G_i = the share of profile i in the information
/// (Kenward and Roger 1997; Meier 1953 for a weighted mean). Degrees of freedom by Satterthwaite's
/// formula (GUM G.4.1) from the uncertainty of the noise's own parameters.
struct Uncertainty {
  Eigen::MatrixXd basis;                       // (A + S) by r
  Eigen::MatrixXd covariance;                  // r by r, of w
  struct NoiseEffect {                         // of one profile whose noise was estimated
    Eigen::MatrixXd covariance;                // of the noise parameters
    std::vector<Eigen::MatrixXd> derivatives;  // of the covariance of w, r by r each
  };
  std::vector<NoiseEffect> noise;
  std::vector<Eigen::MatrixXd> nuisance_covariances;  // per fitted observation

  /// Of row * (amplitudes, shapes). REQUIRES the row to be orthogonal to the null space.
  [[nodiscard]] Spread of(const Eigen::RowVectorXd& row) const;
};

Uncertainty assess(const Linearisation& linear, const std::vector<double>& weights,
                   const std::vector<Noise>& noise, const Eigen::MatrixXd& basis);

/// Student's factor for a coverage probability of 95.45 % (GUM G.3.2): 2 for infinitely many
/// degrees of freedom.
double coverage_factor(const std::optional<double>& degrees_of_freedom);

}  // namespace slideway
