#pragma once

#include <optional>

#include "refine.hpp"

namespace slideway {

/// Error of predicting profiles that were left out of the fit, without and with a candidate. µm
struct HeldOut {
  double before_rms = 0.0, after_rms = 0.0;   // in units of the noise, over all folds
  std::optional<double> before_um, after_um;  // of the height profiles among them
};

/// Leaves out each fitted profile that shows the effect in turn, fits model and effect to the rest
/// and carries the effect over by its clock; offset and tilt of the profile left out are fitted
/// anew. Only folds are counted whose rest tells the effect (5 standard uncertainties, and a tenth
/// of what all profiles know of it) and whose profile shows it (5 times its noise); none: no
/// answer.
std::optional<HeldOut> leave_one_out(const Linearisation& linear, const Whitened& data,
                                     const Refined& candidate);

}  // namespace slideway
