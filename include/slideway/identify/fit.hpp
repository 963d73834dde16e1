#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/model.hpp"
#include "slideway/identify/result.hpp"
#include "slideway/identify/solve.hpp"
#include "slideway/identify/uncertainty.hpp"

namespace slideway {

/// A curve c beside the polynomial p of a slide that refutes its degree: the form is p + c. The
/// coefficients are then those of the polynomial nearest to the form over the travel, equal to it
/// at both ends.
struct OtherForm {
  std::string of;                     // the term of the polynomial
  double log_likelihood_ratio = 0.0;  // over no curve
  ModelTerm curve;                    // its knots are the columns below
  Eigen::MatrixXd moments;            // second moments of the knots, the prior integrated out
  Eigen::MatrixXd nearest;            // amplitudes of the polynomial nearest to a curve, per knot
  Eigen::MatrixXd moved;              // (amplitudes, shapes) per knot: what the fit is off by
};

/// A value of a shape parameter that the data allow beyond U about the estimate.
struct OtherShape {
  Eigen::Index parameter = 0;    // of the model
  double value = 0.0;            // in the parameter's unit
  double chi_square_more = 0.0;  // than at the estimate, all else fitted again
  bool in_uncertainty = false;   // all uncertainties allow for it
};

/// A fitted model with all that later steps need of it.
struct Solution {
  Estimate estimate;  // parameters the data leave free: at 0 (gauge)
  bool converged = false;
  std::string message;
  std::vector<bool> shape_at_bound;
  std::vector<Noise> noise;  // per fitted observation
  Linearisation linear;      // at the estimate; values far off as their loss counts them
  ParameterValues parameters;
  Rank rank;
  NullDirections null;
  Uncertainty uncertainty;
  std::vector<OtherForm> other_forms;    // allow_for_other_form()
  std::vector<OtherShape> other_shapes;  // allow_for_other_shapes()
};

/// Low-band values of the fitted profiles beyond the unknowns of a model; below 0: too few.
Eigen::Index spare_values(const Model& model);

/// @throws UsageError  no profile is to be fitted
/// @throws DataError   fewer low-band values than parameters
void require_enough_data(const Model& model);

/// Fits all profiles jointly by generalised least squares, Eq. (16): solve() under noise_under(),
/// each in turn until the noise stays.
///
/// @param shapes  start from these shapes instead of searching their whole range
/// @throws DataError  fewer low-band values than parameters
Solution fit(const Model& model, const std::optional<Eigen::VectorXd>& shapes = std::nullopt);

/// A model with the fit of its profiles. The fit points into the model: moved, never copied.
struct FittedModel {
  FittedModel(Model of, Solution by) : model(std::move(of)), fit(std::move(by)) {}
  FittedModel(const FittedModel&) = delete;
  FittedModel& operator=(const FittedModel&) = delete;
  FittedModel(FittedModel&&) = default;
  FittedModel& operator=(FittedModel&&) = default;
  ~FittedModel() = default;

  Model model;
  Solution fit;
};

/// A model together with fit(), the values left out that its columns do not describe
/// (left_out.hpp).
FittedModel fit_model(Model model, const std::optional<Eigen::VectorXd>& shapes = std::nullopt);

/// Whether a curve beside the declared polynomial form of the slide, the noise as it is, is
/// likelier than none by 1 / Gates::lack_of_fit_p. If so, all uncertainties allow for the second
/// moments of that curve (OtherForm). Nothing where the model has no polynomial form.
void allow_for_other_form(const Problem& problem, FittedModel& fitted);

/// Whether shapes of declared effects have values that U does not reach, with a χ² that is larger
/// by no more than the square of the coverage factor (profile likelihood: Venzon and Moolgavkar
/// 1988). If so, all uncertainties allow for the largest such change of each shape, and for what
/// the others become with it: a rectangular distribution of that half width. Those of a formula of
/// the user's own do not: like published regressions it has the uncertainties of its linear model.
void allow_for_other_shapes(const Problem& problem, FittedModel& fitted);

/// allow_for_other_form(), then allow_for_other_shapes() beyond the U that it leaves.
void allow_for_others(const Problem& problem, FittedModel& fitted);

/// The same once more, the model taken to be complete: Model::complete.
FittedModel fit_as_complete(FittedModel fitted);

/// The declared model, built and fitted.
/// @throws UsageError, DataError  as build_model(), fit()
FittedModel fit_declared(const Problem& problem, const std::vector<Profile>& profiles);

/// Variance that row * (amplitudes, shapes) has beside what the fit knows of.
using MoreVariance = std::function<double(const Eigen::RowVectorXd& row)>;

/// A solution as reports have it. Parameters, what is determined instead of them, straightness and
/// budget: every uncertainty is widened by `more`.
/// @param with_budget  make ModelResult::budget, too
ModelResult summarise(const Model& model, const Solution& fit, const MoreVariance& more = {},
                      bool with_budget = false);

}  // namespace slideway
