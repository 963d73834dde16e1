#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Low-band values of an observation by index, rising.
using ValueIndices = std::vector<Eigen::Index>;

/// Values of a face that no column describes, whatever the model: within a groove or a low-band
/// value of the spindle axis, where the tool leaves the face. Where the trace passes the axis at
/// X = `axis_mm` and not at X = 0, it is not known on which side of it the values between lie.
ValueIndices values_at_axis(const Observation& observation, const Machine& machine,
                            double axis_mm = 0.0);

/// These, and those further out where effects that are steep at the centre are steeper than the
/// tool's nose follows: a nose of radius ρ cuts a slope z' lower by ρ z'²/2 (first order), and that
/// is more than the noise.
///
/// @param curve  low band of what is steep at the centre
/// @param noise  standard deviation of a low-band value
ValueIndices undescribed_values(const Model& model, const Observation& observation,
                                const Eigen::VectorXd& curve, double noise);

/// Values next to a step of the model: the step of each cut lies between two grooves of its own.
/// They tell where the step is, so a fit keeps them; a search for what is left does not.
ValueIndices values_beside_steps(const Model& model, const Estimate& estimate,
                                 const Observation& observation);

/// Low band of the effects of the model that are steep at the centre.
Eigen::VectorXd steep_curve(const Model& model, const Estimate& estimate,
                            const Observation& observation);

/// Radius out to which values of faces are left out, mm; 0: no face has such values.
double left_out_radius(const Model& model);

}  // namespace slideway
