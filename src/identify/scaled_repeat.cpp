#include <algorithm>
#include <cmath>

#include "repeats.hpp"
#include "slideway/identify/agreement.hpp"

namespace slideway {
namespace {

/// n ln of a mean square: of -2 ln of a likelihood whose variance is free.
double cost(double square, double count) {
  return count * std::log(std::max(square, 1e-300) / count);
}

/// All repeats of one size of noise, this one multiplied, against this one as it is with a size of
/// its own: the difference of -2 ln of their likelihoods.
double difference(const RepeatBeside& as_it_is, const RepeatBeside& multiplied, double factor) {
  const double n = freedom_of(multiplied.off);
  const double share = n / static_cast<double>(multiplied.off.rows());
  const auto others = static_cast<double>(as_it_is.off.cols() - 2);
  return cost(share * (multiplied.own() + multiplied.others()), (others + 1.0) * n) -
         2.0 * n * std::log(std::abs(factor)) - cost(share * as_it_is.others(), others * n) -
         cost(share * as_it_is.own(), n);
}

}  // namespace

std::vector<ScaledRepeat> scaled_repeats(const Linearisation& linear,
                                         std::span<const double> factors, const Gates& gates) {
  std::vector<std::vector<std::size_t>> groups = repeat_groups(linear, gates);
  std::erase_if(groups, [](const auto& group) { return group.size() < kLeastRepeats; });
  std::vector<ScaledRepeat> out;
  if (groups.empty()) return out;
  std::vector<Eigen::VectorXd> values;
  for (const Observation* each : linear.observations) values.push_back(each->values);
  for (const std::vector<std::size_t>& group : groups) {
    const Eigen::MatrixXd parts = slow_parts(linear, values, group, gates);
    if (parts.rows() == 0) continue;
    for (std::size_t k = 0; k < group.size(); ++k) {
      const RepeatBeside as_it_is(parts, static_cast<Eigen::Index>(k));
      for (std::size_t f = 0; f < factors.size(); ++f) {
        const RepeatBeside multiplied(parts, static_cast<Eigen::Index>(k), factors[f]);
        const ScaledRepeat found{group[k], f, difference(as_it_is, multiplied, factors[f]),
                                 multiplied.own() / as_it_is.own()};
        if (found.delta_bic <= -gates.blunder_bic && found.left <= gates.blunder_left)
          out.push_back(found);
      }
    }
  }
  return out;
}

}  // namespace slideway
