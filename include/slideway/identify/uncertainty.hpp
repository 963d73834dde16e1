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

/// Change of (amplitudes, shapes) by a standard deviation of each part of what effects may differ
/// by from what they are taken as (Effect::departures()), a column each. R Rᵀ of laws is added to
/// the covariance of a fit; that of causes is in it, as their errors are part of the noise.
struct DepartureResponse {
  Eigen::MatrixXd to_causes, to_laws;
};

/// Uncertainty of a generalised least-squares estimate.
///
/// In coordinates w in which the information Σ_i G_i + priors is the unit matrix (G_i that of
/// profile i), the covariance of w is
///
///   I + Σ_g p_g (C_g - I) + 2 Σ_i var(ln s_i) (G_i - G_i²)
///
/// where C_g is the covariance under noise g of those the residual allows, p_g its probability, and
/// s_i the part of the long-run variance of profile i's noise that the profiles do not share. The
/// second part makes it the mean over the noises; the third allows for weights that come from the
/// same data (Kenward and Roger 1997, for columns slow against the noise; Meier 1953 for a weighted
/// mean). All is multiplied by the inflation for structure the model lacks (FitNoise). Degrees of
/// freedom by Satterthwaite's formula (GUM G.4.1) from those of each noise's size.
struct Uncertainty {
  Eigen::MatrixXd basis;                     // (A + S) by r
  Eigen::MatrixXd covariance;                // r by r, of w, before the inflation
  double inflation = 1.0;                    // of all variances
  std::vector<Eigen::MatrixXd> information;  // G_i, r by r, per fitted observation
  std::vector<double> size_freedom;          // per fitted observation; 0: its size is known
  std::vector<Eigen::MatrixXd> nuisance_covariances;  // levelling, per fitted observation
  DepartureResponse departures;
  bool has_curve = false;  // whose prior is estimated from the same data: no better known than the
                           // noise

  /// Adds a covariance of (amplitudes, shapes), whatever the inflation.
  /// @param compressed  of the model that assess() had
  void add(const Eigen::MatrixXd& more, const Compressed& compressed);

  /// Of row * (amplitudes, shapes). REQUIRES the row to be orthogonal to the null space.
  [[nodiscard]] Spread of(const Eigen::RowVectorXd& row) const;
};

/// @param compressed  of the same model under the same noise
/// @param basis       (A + S) by r, from analyse_rank()
Uncertainty assess(const Linearisation& linear, const Compressed& compressed,
                   const std::vector<Noise>& noise, const Eigen::MatrixXd& basis,
                   double inflation = 1.0);

/// Student's factor for a coverage probability of 95.45 % (GUM G.3.2): 2 for infinitely many
/// degrees of freedom.
double coverage_factor(const std::optional<double>& degrees_of_freedom);

}  // namespace slideway
