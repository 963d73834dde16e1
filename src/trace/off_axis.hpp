#pragma once

#include <string>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Leaves out of `model`, that of `fitted`, the low-band values of a diameter between center_mm and
/// where the trace passes the spindle axis, X0 beside it: the last groove of the cut may lie there,
/// and the feed marks of the other half.
///
/// X0 is that of the step -X0 z'(r) sgn X beside the model, z' the slope of the face, the values
/// at the axis, up to Gates::most_lost of the radius, taken out of it and of the noise; it counts
/// from Gates::size of its standard uncertainties to Gates::most_lost of the radius. What no cone
/// off the centre leaves there must lower the BIC by Gates::delta_bic once the values are free,
/// each an unknown.
///
/// @return what to say of it; "": nothing is left out
std::string leave_out_off_axis(const FittedModel& fitted, Model& model);

}  // namespace slideway
