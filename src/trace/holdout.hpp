#pragma once

#include <optional>

#include "refine.hpp"

namespace slideway {

/// What a candidate does for profiles that were left out of the fit.
struct HeldOut {
  /// Whether it carries over: see leave_one_out().
  bool helps = false;
  std::optional<double> before_um, after_um;  // rms error of predicting height profiles
};

/// Leaves out each fitted profile that shows the effect in turn, fits model and effect to the rest
/// and carries the effect over by its clock: amplitudes â_-i. It helps if the error of predicting
/// the profile, in units of what the rest leaves uncertain of the model, falls in the sum over all:
/// Σ (G - (â_-i - â)' I (â_-i - â) - G_-i) > 0 with gain G, amplitudes â and their information I of
/// all profiles; and if in each profile that shows it beyond its own model for certain
/// (Gates::size), where the others tell the effect, that residual falls by it. Only folds are
/// counted whose rest knows a share of what all profiles know (Gates::holdout_share); no answer
/// where these profiles together do not show it for certain. What the error of a measured cause
/// makes at this size is noise.
std::optional<HeldOut> leave_one_out(const Model& model, const Linearisation& linear,
                                     const Whitened& data, const Refined& candidate);

}  // namespace slideway
