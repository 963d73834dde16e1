#include "slideway/effects/effect.hpp"

#include <cmath>

namespace slideway {

std::pair<double, double> Effect::search_range(int shape, const Stations& /*stations*/) const {
  const Parameter& parameter = parameters()[shapes()[shape].parameter];
  return {parameter.lower, parameter.upper};
}

double Effect::resolution(int shape, double value, const Stations& stations) const {
  constexpr double kSteps = 40.0;
  const auto [low, high] = search_range(shape, stations);
  return shapes()[shape].logarithmic ? value * std::log(high / low) / kSteps
                                     : (high - low) / kSteps;
}

std::vector<std::string> Effect::lacking(const Setup& setup) const {
  return missing_for(description().variable, setup);
}

void Effect::columns_of_shapes(const Stations& stations,
                               std::span<const std::vector<double>> shapes,
                               Eigen::Ref<Eigen::MatrixXd> out) const {
  for (std::size_t s = 0; s < shapes.size(); ++s)
    columns(stations, shapes[s],
            out.middleCols(static_cast<Eigen::Index>(s) * amplitudes(), amplitudes()));
}

void Effect::derivatives(const Stations& /*stations*/, std::span<const double> /*shape*/,
                         int /*which*/, Eigen::Ref<Eigen::MatrixXd> out) const {
  out.setZero();
}

}  // namespace slideway
