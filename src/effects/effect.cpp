#include "slideway/effects/effect.hpp"

namespace slideway {

std::pair<double, double> Effect::search_range(int shape, const Stations& /*stations*/) const {
  const Parameter& parameter = parameters()[shapes()[shape].parameter];
  return {parameter.lower, parameter.upper};
}

std::vector<std::string> Effect::lacking(const Setup& setup) const {
  return missing_for(description().clock, setup);
}

void Effect::derivatives(const Stations& /*stations*/, std::span<const double> /*shape*/,
                         int /*which*/, Eigen::Ref<Eigen::MatrixXd> out) const {
  out.setZero();
}

}  // namespace slideway
