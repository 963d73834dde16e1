#pragma once

#include "round.hpp"
#include "structure.hpp"

namespace slideway {

/// Widens the uncertainties of the fitted parameters for what is left and has no name: by what the
/// process that describes it could put into them unseen, and by the largest change that one of the
/// effects refused in spite of their gain would bring (a rectangular distribution of that half
/// width).
void widen(const Model& model, const Fit& fit, const Structure& structure, const Look& last,
           std::vector<FittedParameter>& parameters);

}  // namespace slideway
