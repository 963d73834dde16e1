#pragma once

#include <vector>

#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/model.hpp"
#include "slideway/identify/result.hpp"
#include "slideway/identify/uncertainty.hpp"

namespace slideway {

/// A fitted model with all that later steps need of it.
struct Fit {
  Estimate estimate;  // parameters the data leave free: at 0 (gauge)
  bool converged = false;
  std::string message;
  std::vector<bool> shape_at_bound;
  std::vector<double> weights;  // per fitted observation
  std::vector<Noise> noise;     // per fitted observation
  Linearisation linear;         // at the estimate
  ParameterValues parameters;
  Rank rank;
  NullDirections null;
  Uncertainty uncertainty;
};

/// Fits all profiles jointly: weighted least squares, the weights from each profile's long-run
/// noise (declared, or estimated from the residual), uncertainties for the noise's correlation.
///
/// @param shapes  start from these shapes instead of searching their whole range
/// @throws DataError  fewer low-band values than parameters
Fit fit(const Model& model, const std::optional<Eigen::VectorXd>& shapes = std::nullopt);

/// The fit for the report.
FitResult summarise(const Model& model, const Fit& fit);

}  // namespace slideway
