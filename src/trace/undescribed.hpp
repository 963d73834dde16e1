#pragma once

#include "whitened.hpp"

namespace slideway {

/// Low-band values that a model and an effect under suspicion leave undescribed beyond those
/// already left out (left_out.hpp).
/// @param suspect  stacked low band of the effect; empty: none
FreeValues undescribed_beside(const Model& model, const Solution& fit,
                              const std::vector<Noise>& noise, const Eigen::VectorXd& suspect = {});

/// How many values of all profiles.
std::size_t count_of(const FreeValues& values);

}  // namespace slideway
