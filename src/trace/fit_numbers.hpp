#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/result.hpp"

namespace slideway {

/// Rms residual of the held-out height profiles, or none. µm
std::optional<double> holdout_rms_um(const ModelResult& fit);

/// Parameters of one effect.
std::vector<FittedParameter> parameters_of(const ModelResult& fit, const std::string& effect);

}  // namespace slideway
