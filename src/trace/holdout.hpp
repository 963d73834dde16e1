#pragma once

#include <optional>

#include "refine.hpp"

namespace slideway {

/// What a candidate does for profiles that were left out of the fit.
struct HeldOut {
  /// Whether it carries over: the left-out profiles' white residual outside their own model falls
  /// by it; where it shows only inside that, whether they are predicted better.
  bool helps = false;
  std::optional<double> before_um, after_um;  // rms error of predicting height profiles
};

/// Leaves out each fitted profile that shows the effect in turn, fits model and effect to the rest
/// and carries the effect over by its clock; offset and tilt of the profile left out are fitted
/// anew. Only folds are counted whose rest tells the effect (5 standard uncertainties, and a tenth
/// of what all profiles know of it) and whose profile shows it (5 times its noise); none: no
/// answer.
std::optional<HeldOut> leave_one_out(const Linearisation& linear, const Whitened& data,
                                     const Refined& candidate);

}  // namespace slideway
