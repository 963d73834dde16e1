#pragma once

#include <vector>

#include "slideway/identify/pooling.hpp"

namespace slideway {

/// The trend of every parameter that three items or more, at different times, determine.
std::vector<Trend> trends(const std::vector<std::vector<FittedParameter>>& items,
                          const std::vector<double>& times);

}  // namespace slideway
