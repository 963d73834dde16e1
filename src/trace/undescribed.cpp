#include "undescribed.hpp"

#include <algorithm>
#include <iterator>

#include "slideway/identify/left_out.hpp"
#include "slideway/identify/low_band_lines.hpp"

namespace slideway {

std::size_t count_of(const FreeValues& values) {
  std::size_t out = 0;
  for (const ValueIndices& each : values) out += each.size();
  return out;
}

FreeValues undescribed_beside(const Model& model, const Solution& fit,
                              const std::vector<Noise>& noise, const Eigen::VectorXd& suspect) {
  FreeValues out;
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < fit.linear.observations.size(); ++i) {
    const Observation& observation = *fit.linear.observations[i];
    Eigen::VectorXd curve = steep_curve(model, fit.estimate, observation);
    if (suspect.size() > 0) curve += suspect.segment(first, curve.size());
    const ValueIndices known = left_out_values(observation);
    ValueIndices either, &own = out.emplace_back();
    std::ranges::set_union(
        undescribed_values(model, observation, curve, noise[i].standard_deviation()),
        values_beside_steps(model, fit.estimate, observation), std::back_inserter(either));
    std::ranges::set_difference(either, known, std::back_inserter(own));
    first += observation.values.size();
  }
  return out;
}

}  // namespace slideway
