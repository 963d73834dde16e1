#pragma once

/// Tails and quantiles of the distributions that tests and intervals rest on. Freedoms are degrees
/// of freedom, > 0, and need not be whole; probabilities lie in (0, 1).
namespace slideway {

/// Probability that Student's t exceeds t, on one side.
double student_tail(double freedom, double t);
/// What Student's t exceeds with this probability, on one side.
double student_limit(double freedom, double tail);

/// What Fisher's F exceeds with this probability.
double fisher_limit(double numerator_freedom, double denominator_freedom, double tail);

/// Probability that χ² exceeds x.
double chi_squared_tail(double freedom, double x);
/// Below it χ² lies with this probability.
double chi_squared_quantile(double freedom, double probability);
/// The non-centrality at which χ² lies below x with this probability; not finite where it cannot
/// be evaluated.
double chi_squared_noncentrality(double freedom, double x, double probability);

/// Q(a, x), the regularised upper incomplete gamma function.
double gamma_tail(double a, double x);
/// I_x(a, b), the regularised incomplete beta function.
double beta_share(double a, double b, double x);

}  // namespace slideway
