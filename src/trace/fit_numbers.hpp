#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"
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

/// By how much the uncertainty of an effect's first parameter is larger because its law may bend
/// (Gates::drift_bend), at least 1. That part grows with the size and is no doubt that it is there.
double widening_by_bend(const Solution& fit, const ModelTerm& term);

}  // namespace slideway
