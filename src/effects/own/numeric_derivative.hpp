#pragma once

#include <Eigen/Core>
#include <functional>

namespace slideway {

// A derivative and what it may be off by at most, as the extrapolation shows it.
struct NumericDerivative {
  Eigen::MatrixXd value;
  double error = 0.0;
};

// d f / d p at p by Ridders' method: differences over a step that is halved, extrapolated to step 0
// (Numerical Recipes, 5.7); the entry of the tableau that changes least is taken, and its change is
// the error. Differences are central, or one-sided where p lies at an end of [lower, upper], which
// f is never asked beyond.
// REQUIRES lower < upper, step > 0.
NumericDerivative numeric_derivative(const std::function<Eigen::MatrixXd(double)>& f, double p,
                                     double step, double lower, double upper);

}  // namespace slideway
