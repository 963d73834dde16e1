#pragma once

#include "calibration.hpp"
#include "refine.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// For every candidate the size that is found with 80 % probability, in the unit of its first
/// parameter: its gain must pass what the search finds in noise, ΔBIC -10, five standard
/// uncertainties, and three in a joint fit whose residual has `joint_noise`. None for a candidate
/// the model spans or all but spans (found only beyond a hundred times the range of a profile), or
/// whose size is not one number. For an effect of several shapes the first runs from end to end and
/// the others stand in the middle of what the search covers.
std::vector<DetectionLimit> detection_limits(const FittedModel& fitted, const Whitened& data,
                                             const std::vector<Noise>& joint_noise,
                                             const Candidates& candidates,
                                             const Calibration& calibration, double significance);

/// Candidates whose columns the model makes itself, with the parameters that make them: (cup,
/// "straightness.b2").
std::vector<std::pair<std::string, std::string>> inseparable(const Model& model,
                                                             const Solution& fit,
                                                             const Whitened& data,
                                                             const Candidates& candidates);

}  // namespace slideway
