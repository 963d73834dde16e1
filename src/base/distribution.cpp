#include "slideway/base/distribution.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace slideway {
namespace {

namespace policies = boost::math::policies;
// Plain doubles, a quarter of the time: the curve of a straightness asks for hundreds.
using Plain = policies::policy<policies::promote_double<false>>;
// Plain doubles; not finite instead of an exception.
using Quiet = policies::policy<policies::domain_error<policies::ignore_error>,
                               policies::evaluation_error<policies::ignore_error>,
                               policies::overflow_error<policies::ignore_error>,
                               policies::promote_double<false>>;

}  // namespace

double student_tail(double freedom, double t) {
  return cdf(complement(boost::math::students_t(freedom), t));
}

double student_limit(double freedom, double tail) {
  using Distribution = boost::math::students_t_distribution<double, Plain>;
  return quantile(complement(Distribution(freedom), tail));
}

double fisher_limit(double numerator_freedom, double denominator_freedom, double tail) {
  return quantile(complement(boost::math::fisher_f(numerator_freedom, denominator_freedom), tail));
}

double chi_squared_tail(double freedom, double x) { return gamma_tail(0.5 * freedom, 0.5 * x); }

double chi_squared_quantile(double freedom, double probability) {
  return quantile(boost::math::chi_squared(freedom), probability);
}

double chi_squared_noncentrality(double freedom, double x, double probability) {
  using Distribution = boost::math::non_central_chi_squared_distribution<double, Quiet>;
  return Distribution::find_non_centrality(freedom, x, probability);
}

double gamma_tail(double a, double x) { return boost::math::gamma_q(a, x); }

double beta_share(double a, double b, double x) { return boost::math::ibeta(a, b, x); }

}  // namespace slideway
