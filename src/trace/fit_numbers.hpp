#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/model.hpp"
#include "slideway/identify/result.hpp"

namespace slideway {

/// Rms residual of the held-out height profiles, or none. µm
std::optional<double> holdout_rms_um(const ModelResult& fit);

/// Parameters of one effect.
std::vector<FittedParameter> parameters_of(const ModelResult& fit, const std::string& effect);

/// Size of an effect's first parameter in its standard uncertainties, of few degrees of freedom in
/// those of a normal distribution with the same U; infinite where one of the two is not known.
double size_in_uncertainties(const ModelResult& fit, const ModelTerm& term);

}  // namespace slideway
