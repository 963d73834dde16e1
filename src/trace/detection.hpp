#pragma once

#include "calibration.hpp"
#include "refine.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

/// For every candidate the size that is found with the probability Gates::detection_power, in the
/// unit of its first parameter: its gain must pass what the search finds in noise, delta_bic and
/// size, in the search and under the noise of the fit. None for a candidate the model spans or all
/// but spans (found only beyond a hundred times the range of a profile), or whose size is not one
/// number. For an effect of several shapes the first runs from end to end and the others stand in
/// the middle of what the search covers.
std::vector<DetectionLimit> detection_limits(const FittedModel& fitted, const Whitened& data,
                                             const std::vector<Noise>& fit_noise,
                                             const Candidates& candidates,
                                             const Calibration& calibration);

/// "position_mm = 3, width_mm = 0.5"
std::string shape_text(const Candidate& candidate, std::span<const double> shape);

/// Candidates whose columns the model makes itself, with the parameters that make them: (cup,
/// "straightness.b2").
std::vector<NotSeparable> inseparable(const Model& model, const Solution& fit, const Whitened& data,
                                      const Candidates& candidates);

/// Standard uncertainty of an effect's decisive parameter over its value.
/// @param covariance  of amplitudes and shapes
double relative_uncertainty(const Effect& effect, const Eigen::VectorXd& amplitudes,
                            std::span<const double> shape, const Eigen::MatrixXd& covariance);

}  // namespace slideway
