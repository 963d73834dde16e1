#pragma once

#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// One budget for each identifiable parameter. Where `more` is given, what it adds is a line of its
/// own.
std::vector<Budget> uncertainty_budget(const Model& model, const Solution& fit,
                                       const MoreVariance& more = {});

}  // namespace slideway
