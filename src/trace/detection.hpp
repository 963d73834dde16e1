#pragma once

#include "calibration.hpp"
#include "refine.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// For every candidate the size that is found with 80 % probability, in the unit of its first
/// parameter: its gain must pass what the search finds in noise, ΔBIC -10, five standard
/// uncertainties, and three in a joint fit whose residual has `joint_noise`. None for a candidate
/// the model spans or all but spans (found only where it is no flatness any more, beyond 1 mm or
/// rad in a low band), or whose size is not one number.
std::vector<DetectionLimit> detection_limits(const FittedModel& fitted, const Whitened& data,
                                             const std::vector<Noise>& joint_noise,
                                             const Candidates& candidates,
                                             const Calibration& calibration, double significance);

/// Candidates whose columns the model makes itself, with the parameters that make them: (cup,
/// "straightness.b2").
std::vector<NotSeparable> inseparable(const Model& model, const Solution& fit, const Whitened& data,
                                      const Candidates& candidates);

}  // namespace slideway
