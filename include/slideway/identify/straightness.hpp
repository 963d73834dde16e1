#pragma once

#include <Eigen/Core>
#include <optional>

#include "slideway/identify/fit.hpp"

/// Straightness as ISO 230-1:2012 evaluates it: deviations from a stated reference line.
namespace slideway {

/// None where the model has no straightness.
std::optional<Straightness> identified_straightness(const Model& model, const Solution& fit,
                                                    const MoreVariance& more = {});

}  // namespace slideway
