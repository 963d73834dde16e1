#pragma once

#include <string>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/left_out.hpp"

namespace slideway {

/// Low-band values of a diameter at the end of it that has left the face: a trace whose centre lies
/// off the spindle axis runs past one rim. What the cut left at the rim, both ends show at one
/// radius.
///
/// The difference of the two halves at each radius is extrapolated to the rim, over
/// Gates::most_lost of the radius, by a parabola through four times as much. Where it is off by
/// more than Gates::one_rim times the root mean square of what the same extrapolation is off by
/// further in, the values of both ends are taken, inwards until half of that. Empty: the profile is
/// no diameter, or its ends agree.
///
/// @param residual  of the low band, without what is free in the trace
ValueIndices values_past_a_rim(const Observation& observation, const Eigen::VectorXd& residual,
                               const Gates& gates);

/// Leaves them out of `model`, that of `fitted`. @return what to say of it; "": there are none
std::string leave_out_past_rims(const FittedModel& fitted, Model& model);

}  // namespace slideway
