#pragma once

#include <vector>

#include "slideway/identify/model.hpp"

namespace slideway {

/// Values of a shape parameter at which a search looks, increasing: over what the fitted profiles
/// can show in their low band, in steps of Effect::resolution(); for a stepwise shape every place
/// between two low-band values. The middle of the parameter's range where no profile shows it.
std::vector<double> shape_grid(const Model& model, const ModelTerm& term, int shape);

}  // namespace slideway
