#pragma once

#include "refine.hpp"

namespace slideway {

/// The effect of the model whose line an effect only modulates: in every fitted profile all of its
/// lines lie beside those of that effect, nearer than the gates modulation_widths (in resolutions
/// of the profile's spectrum, one cycle a profile) and modulation_share (of the line's own rate).
/// A line of one face alone may also be a harmonic of its feed marks that sampling folds to there.
/// Empty: none.
std::string modulated_effect(const Model& model, const Eigen::VectorXd& shapes,
                             const Refined& refined);

}  // namespace slideway
