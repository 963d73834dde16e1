#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/model.hpp"

namespace slideway {

/// State of a fit: values of everything that is free.
struct Estimate {
  Eigen::VectorXd amplitudes;  // of all terms
  Eigen::VectorXd shapes;
  std::vector<Eigen::VectorXd> nuisances;  // per fitted observation
};

/// The model linearised at an estimate, on the observations with Role::fit and under given weights:
/// columns of amplitudes and of shapes, the residual, and what it takes to compress them.
struct Linearisation {
  std::vector<const Observation*> observations;
  std::vector<Eigen::MatrixXd> columns;         // per observation: #values by (A + S)
  std::vector<Eigen::MatrixXd> nuisance_bases;  // per observation: orthonormal
  std::vector<Eigen::MatrixXd> triangles;       // of the columns with the nuisances projected out
  std::vector<Eigen::VectorXd> squares;         // sums over each column before that
  std::vector<Eigen::VectorXd> residuals;       // values - model - nuisances
  Eigen::MatrixXd prior_rows;                   // #priors by (A + S), divided by their uncertainty
  Eigen::VectorXd prior_residuals;              // (prior - value) / uncertainty
};

struct SolveSummary {
  Estimate estimate;
  bool converged = false;
  std::string message;
  std::vector<bool> shape_at_bound;
};

/// Starting values: the given shapes, or each in the middle of its grid; all else zero.
Estimate initial_estimate(const Model& model, const std::optional<Eigen::VectorXd>& shapes = {});

/// The observations with Role::fit, in order.
std::vector<const Observation*> fitted_observations(const Model& model);

/// What all effects together put into an observation's low band.
Eigen::VectorXd model_values(const Model& model, const Observation& observation,
                             const Estimate& estimate);

/// Nuisances of an observation that fit `rest` best.
Eigen::VectorXd fitted_nuisances(const Observation& observation, const Eigen::VectorXd& rest);

Linearisation linearise(const Model& model, const Estimate& estimate);

/// The same at another estimate; columns are computed again only where a shape could move them.
void relinearise(const Model& model, const Estimate& estimate, Linearisation& linear);

/// relinearise() with every profile's nuisances brought to their best.
void refit_nuisances(const Model& model, Estimate& estimate, Linearisation& linear);

/// Finds the amplitudes and shapes that minimise, with each profile's nuisances at their best,
///   Σ_i |values_i - model_i - nuisances_i|² / weight_i²  +  Σ ((prior - parameter) / u)²
/// Linear columns are compressed by orthogonal factorisation first; Ceres solves what is left,
/// together with the shapes (whose fixed linear partners are projected out) inside their bounds.
///
/// @param linear   linearise() at any estimate; left at the solution
/// @param weights  per fitted observation, mm or rad: standard deviation to divide by
/// @param scan     look for the shapes over their whole range first, instead of from `start`
SolveSummary solve(const Model& model, Linearisation& linear, const std::vector<double>& weights,
                   const Estimate& start, bool scan);

/// Parameters of all terms and their Jacobian: P values, P by (A + S).
ParameterValues all_parameters(const Model& model, const Estimate& estimate);

/// Upper triangle R of the weighted columns C with the nuisances projected out (A + S wide, priors
/// included), their products with the weighted residuals, and the norm each column had before.
struct Triangle {
  Eigen::MatrixXd matrix;    // R'R = C'C
  Eigen::VectorXd gradient;  // C' residuals
  Eigen::VectorXd scale;
};

/// Takes no longer for more values, but for the gradient.
Triangle compress(const Linearisation& linear, const std::vector<double>& weights);

}  // namespace slideway
