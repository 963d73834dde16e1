#pragma once

#include "search.hpp"

namespace slideway {

/// A candidate at the shape that fits best.
struct Refined {
  const Candidate* candidate = nullptr;
  std::vector<double> shape;
  Eigen::MatrixXd columns;  // stacked, not whitened
  Projection projection;
  double delta_bic = 0.0;
  bool at_end = false;  // the shape lies at an end of what the search covers

  /// Parameter values with the standard uncertainties the whitened data give, shape and amplitudes
  /// together.
  Eigen::VectorXd values, uncertainties;
  double size_in_uncertainties = 0.0;  // size of the effect over its own uncertainty
};

/// Takes a finding from the grid to the best shape next to it: Ceres on the shape alone, the linear
/// part eliminated (variable projection, Kaufman's Jacobian); a stepwise shape is tried at every
/// sample instead.
Refined refine(const Model& model, const Whitened& data, const Finding& finding);

}  // namespace slideway
