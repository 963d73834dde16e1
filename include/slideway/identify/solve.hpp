#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/curve_prior.hpp"
#include "slideway/identify/model.hpp"
#include "slideway/identify/noise.hpp"

namespace slideway {

/// State of a fit: values of everything that is free.
struct Estimate {
  Eigen::VectorXd amplitudes;  // of all terms
  Eigen::VectorXd shapes;
  std::vector<Eigen::VectorXd> nuisances;  // per fitted observation
  std::optional<CurvePrior> curve;         // where a term is a curve
};

/// The model linearised at an estimate, on the observations with Role::fit.
struct Linearisation {
  std::vector<const Observation*> observations;
  std::vector<Eigen::MatrixXd> columns;    // per observation: #values by (A + S)
  std::vector<Eigen::VectorXd> residuals;  // values - model - nuisances
  Eigen::MatrixXd prior_rows;              // #priors by (A + S), divided by their uncertainty
  Eigen::VectorXd prior_residuals;         // (prior - value) / uncertainty
  Eigen::Index curve_rows = 0;             // the last of them: the prior of a curve
  std::vector<Eigen::MatrixXd> errors_of_causes;  // per observation: #values by k; or empty: none
};

/// The observations with Role::fit, in order.
std::vector<const Observation*> fitted_observations(const Model& model);

/// What all effects together put into an observation's low band.
Eigen::VectorXd model_values(const Model& model, const Observation& observation,
                             const Estimate& estimate);

/// Nuisances of an observation that fit `rest` best by ordinary least squares: the levelling of a
/// profile whose noise is not known.
Eigen::VectorXd fitted_nuisances(const Observation& observation, const Eigen::VectorXd& rest);

/// Low-band columns of all amplitudes and derivatives by all shapes: #values by (A + S).
Eigen::MatrixXd linear_columns(const Model& model, const Estimate& estimate,
                               const Observation& observation);

Linearisation linearise(const Model& model, const Estimate& estimate);

/// The same at another estimate; columns are computed again only where a shape could move them.
void relinearise(const Model& model, const Estimate& estimate, Linearisation& linear);

/// Residuals and priors at an estimate, the columns as they are.
void set_residuals(const Model& model, const Estimate& estimate, Linearisation& linear);

/// relinearise() with nothing left of the values that are left out.
void settle_residuals(const Model& model, Estimate& estimate, Linearisation& linear);

/// Parameters of all terms and their Jacobian: P values, P by (A + S).
ParameterValues all_parameters(const Model& model, const Estimate& estimate);

/// Index of a parameter within its effect. @throws UsageError if there is none of that name
Eigen::Index parameter_index(const ModelTerm& term, const std::string& name);

/// One profile of a linearised model, white and compressed: Qᵀ W [nuisances, columns, residual] is
/// upper triangular, W the whitening of its noise. No inner product is lost.
///
/// Values that are left out have nuisances of their own; they come first and are cut off, so the
/// rows here are free of them.
class ProfileTriangle {
 public:
  ProfileTriangle(const Observation& observation, const Noise& noise,
                  const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual);

  [[nodiscard]] Eigen::Index levelling() const { return levelling_; }  // offset, tilt: 0 ... 2
  [[nodiscard]] Eigen::Index columns() const { return upper_.cols() - levelling_ - 1; }

  /// [levelling, columns, residual], all rows.
  [[nodiscard]] const Eigen::MatrixXd& upper() const { return upper_; }
  /// [columns, residual], levelling eliminated.
  [[nodiscard]] auto free() const {
    return upper_.bottomRightCorner(upper_.rows() - levelling_, columns() + 1);
  }
  /// Squared norms of the white columns before anything was eliminated.
  [[nodiscard]] const Eigen::VectorXd& squares() const { return squares_; }

  /// The levelling that fits best after (amplitudes, shapes) have changed.
  [[nodiscard]] Eigen::VectorXd levelled(const Eigen::VectorXd& change) const;
  /// Its covariance, where (amplitudes, shapes) have this one.
  [[nodiscard]] Eigen::MatrixXd levelling_covariance(const Eigen::MatrixXd& of_columns) const;

 private:
  [[nodiscard]] Eigen::MatrixXd levelling_inverse() const;

  Eigen::Index levelling_;
  Eigen::MatrixXd upper_;
  Eigen::VectorXd squares_;
};

/// All profiles and priors of a linearised model, white and compressed. A change x of (amplitudes,
/// shapes) leaves |R x - Qᵀ r|² more than the best.
struct Compressed {
  std::vector<ProfileTriangle> profiles;  // per fitted observation
  Eigen::MatrixXd triangle;  // R, square: RᵀR is the information on (amplitudes, shapes)
  Eigen::VectorXd target;    // Qᵀ r
  Eigen::VectorXd scale;     // norm of each white column
};

/// @param noise  per fitted observation
Compressed compress(const Linearisation& linear, const std::vector<Noise>& noise);

struct SolveSummary {
  Estimate estimate;
  bool converged = false;
  std::string message;
  std::vector<bool> shape_at_bound;
};

/// Starting values: the given shapes, or each in the middle of its grid; all else zero.
Estimate initial_estimate(const Model& model, const std::optional<Eigen::VectorXd>& shapes = {});

/// Shapes looked for over their whole range, one after the other, the linear part optimal at every
/// point.
void scan_shapes(const Model& model, const std::vector<Noise>& noise, Estimate& estimate);

/// Generalised least squares: finds levelling ν_i, amplitudes a_e and shapes u_e that minimise
///
///   Σ_i Σ_t ρ_i( [W_i (y_i - N_i ν_i - Σ_e C_e(u_e) a_e)]_t² )  +  Σ ((prior - parameter) / u)²
///
/// with the whitening W_i of each profile's noise and its loss ρ_i, shapes inside their bounds.
/// The solver is Ceres; where shapes move, it begins at the optimum of the problem with the
/// amplitudes eliminated (variable projection: Golub and Pereyra 1973, Kaufman 1975), priors and
/// losses left aside, with the best amplitudes there.
///
/// @param linear  linearise() at any estimate; left at the solution
/// @param noise   per fitted observation
SolveSummary solve(const Model& model, Linearisation& linear, const std::vector<Noise>& noise,
                   const Estimate& start);

}  // namespace slideway
