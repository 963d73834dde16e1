#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/effects/effect.hpp"

/// The form of a slide as a curve: a Gaussian process along the slide, whose size, length and
/// roughness are estimated by restricted likelihood (Rasmussen and Williams 2006, 2.7 and 5.4.1).
namespace slideway {

struct Estimate;
struct Linearisation;
struct Model;
struct ModelTerm;
class Noise;

/// A place where the slope may jump, as where a way was cut short: a triangle over the travel.
struct CurveKink {
  Eigen::Index knot = 0;   // where it is
  double height_mm = 0.0;  // standard deviation of its height there

  bool operator==(const CurveKink&) const = default;
};

/// Covariance of the curve at two places a distance d apart, Matérn's: a² M_ν(d / ℓ) with
///   M_3/2(u) = (1 + √3 u) exp(-√3 u),  M_5/2(u) = (1 + √5 u + 5/3 u²) exp(-√5 u).
/// At ν = 3/2 the curve has a slope everywhere, and the slope has kinks. Beside that a bow, a
/// parabola over the travel, whose size is not estimated from the rest of the curve: readings that
/// cannot tell it from a drift leave it open.
struct CurvePrior {
  double amplitude_mm = 0.0;          // a, the standard deviation about b_0 + b_1 x and the bow
  double length_mm = 0.0;             // ℓ
  double roughness = 1.5;             // ν
  double bow_mm = 0.0;                // standard deviation of the height of the bow
  std::vector<CurveKink> kinks = {};  // each with a variance of its own

  bool operator==(const CurvePrior&) const = default;
};

/// The term of a model whose amplitudes are a curve, or null.
const ModelTerm* curve_term(const Model& model);

/// What a fit begins with: as large as the readings, its bow as well, as long as a quarter of the
/// travel.
CurvePrior first_curve_prior(const Model& model, const Knots& knots);

/// Rows R of the knots' amplitudes with RᵀR the inverse of their covariance.
Eigen::MatrixXd curve_prior_rows(const Knots& knots, const CurvePrior& prior);

/// What the data say of a curve under a noise, everything else in the model left free.
struct CurveEstimate {
  CurvePrior prior;            // of the largest restricted likelihood
  Eigen::MatrixXd determined;  // #knots by q: what the data say more of than the prior does; at
                               // most a third as many as there are values: the rest tell the noise
};

/// The restricted likelihood is evaluated on a grid: ν of 3/2 and 5/2, lengths from two
/// distances of knots to twice the travel, every amplitude between nothing and a curve that is
/// free; no kink, or as likely one at any knot, about as high as the readings; beside the likeliest
/// kink a further one, until none makes the data likelier. REQUIRES a curve_term().
/// @param linear  at the estimate
/// @param noise   per fitted observation
CurveEstimate estimate_curve(const Model& model, const Linearisation& linear,
                             const std::vector<Noise>& noise, const Estimate& estimate);

/// Of values too few to tell a form at each knot from noise, the noise is known by how likely they
/// are under it and the likeliest curve: the factor of its variances, the largest one that is about
/// as likely as any. 1 where they are enough, or where an uncertainty is declared.
/// REQUIRES a curve_term().
double noise_beside_curve(const Model& model, const Linearisation& linear,
                          const std::vector<Noise>& noise, const Estimate& estimate);

/// What the uncertainty of the prior adds to the covariance of (amplitudes, shapes): the second
/// moment about the estimate of all priors, each by its likelihood (of several kinks the last one
/// at any knot), and of the sizes of the noise where noise_beside_curve() looks for one, less the
/// covariance under those of the estimate.
/// REQUIRES a curve_term().
Eigen::MatrixXd covariance_of_curve_prior(const Model& model, const Linearisation& linear,
                                          const std::vector<Noise>& noise,
                                          const Estimate& estimate);

/// The linearisation at a straight slide, with a curve's columns replaced by those that the data
/// determine, left free: what the noise is estimated beside.
Linearisation beside_curve(const Model& model, const Linearisation& linear,
                           const CurveEstimate& curve, const Estimate& estimate);

}  // namespace slideway
