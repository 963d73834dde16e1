#include <cmath>
#include <numeric>

#include "repeats.hpp"
#include "slideway/identify/agreement.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

/// One repeat of a group beside the others, its values multiplied by a factor: what it is off their
/// mean, and what they are off it, of the variance that one reading has.
struct Beside {
  Eigen::MatrixXd off;  // this one first

  Beside(const Eigen::MatrixXd& parts, Eigen::Index which, double factor)
      : off(parts.rows(), parts.cols()) {
    const auto count = static_cast<double>(parts.cols());
    const Eigen::VectorXd mean = (parts.rowwise().sum() - parts.col(which)) / (count - 1.0);
    off.col(0) = std::sqrt((count - 1.0) / count) * (factor * parts.col(which) - mean);
    for (Eigen::Index k = 0, next = 1; k < parts.cols(); ++k)
      if (k != which) off.col(next++) = parts.col(k) - mean;
  }
  [[nodiscard]] double own() const { return off.col(0).squaredNorm(); }
  [[nodiscard]] double others() const { return off.rightCols(off.cols() - 1).squaredNorm(); }
};

/// n ln of a mean square: of -2 ln of a likelihood whose variance is free.
double cost(double square, double count) {
  return count * std::log(std::max(square, 1e-300) / count);
}

/// All repeats of one size of noise, this one multiplied, against this one as it is with a size of
/// its own: the difference of -2 ln of their likelihoods.
double difference(const Beside& as_it_is, const Beside& multiplied, double factor) {
  const Eigen::VectorXd spectrum = smoothed(multiplied.off.rowwise().squaredNorm());
  const double n = std::pow(spectrum.sum(), 2) / spectrum.squaredNorm();  // Satterthwaite (1946)
  const double share = n / static_cast<double>(spectrum.size());
  const auto others = static_cast<double>(as_it_is.off.cols() - 2);
  return cost(share * (multiplied.own() + multiplied.others()), (others + 1.0) * n) -
         2.0 * n * std::log(std::abs(factor)) - cost(share * as_it_is.others(), others * n) -
         cost(share * as_it_is.own(), n);
}

}  // namespace

std::vector<ScaledRepeat> scaled_repeats(const Linearisation& linear,
                                         std::span<const double> factors, const Gates& gates) {
  std::vector<Eigen::VectorXd> values;
  for (const Observation* each : linear.observations) values.push_back(each->values);
  std::vector<ScaledRepeat> out;
  for (const std::vector<std::size_t>& group : repeat_groups(linear, gates)) {
    if (group.size() < kLeastRepeats) continue;
    const Eigen::MatrixXd parts = slow_parts(linear, values, group, gates);
    if (parts.rows() == 0) continue;
    for (std::size_t k = 0; k < group.size(); ++k) {
      const Beside as_it_is(parts, static_cast<Eigen::Index>(k), 1.0);
      for (const double factor : factors) {
        const Beside multiplied(parts, static_cast<Eigen::Index>(k), factor);
        const ScaledRepeat found{group[k], factor, difference(as_it_is, multiplied, factor),
                                 multiplied.own() / as_it_is.own()};
        if (found.delta_bic <= -gates.blunder_bic && found.left <= gates.blunder_left)
          out.push_back(found);
      }
    }
  }
  return out;
}

}  // namespace slideway
