#pragma once

/// Tail probabilities and quantiles for tests and intervals. Degrees of freedom are > 0 and need
/// not be whole; probabilities lie in (0, 1).
namespace slideway {

/// Probability that Student's t exceeds t, on one side.
double student_tail(double freedom, double t);
/// Upper one-sided quantile of Student's t.
double student_limit(double freedom, double tail);

/// Upper quantile of Fisher's F.
double fisher_limit(double numerator_freedom, double denominator_freedom, double tail);

/// Probability that χ² exceeds x.
double chi_squared_tail(double freedom, double x);
/// Quantile of χ²: it lies below with this probability.
double chi_squared_quantile(double freedom, double probability);
/// The non-centrality at which non-central χ² lies below x with this probability; not finite if it
/// cannot be evaluated.
double chi_squared_noncentrality(double freedom, double x, double probability);

/// Q(a, x), the regularised upper incomplete gamma function.
double gamma_tail(double a, double x);
/// I_x(a, b), the regularised incomplete beta function.
double beta_share(double a, double b, double x);

}  // namespace slideway
