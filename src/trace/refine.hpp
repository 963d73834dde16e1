#pragma once

#include "search.hpp"

namespace slideway {

/// A candidate at the shapes that fit best.
struct Refined {
  const Candidate* candidate = nullptr;
  std::vector<double> shape;
  Eigen::MatrixXd columns;  // stacked, not whitened
  Projection projection;
  double delta_bic = 0.0;
  bool at_end = false;  // a shape lies at an end of what the search covers

  /// Parameter values with the standard uncertainties the whitened data give, shapes and amplitudes
  /// together.
  Eigen::VectorXd values, uncertainties;
  double size_in_uncertainties = 0.0;  // size of the effect over its own uncertainty
};

/// Takes a finding from the grid to the best shapes next to it: Ceres on all smooth shapes
/// together, the linear part eliminated (variable projection, Kaufman's Jacobian); a stepwise shape
/// is tried at every place between two samples instead.
Refined refine(const Model& model, const Whitened& data, const Finding& finding);

}  // namespace slideway
