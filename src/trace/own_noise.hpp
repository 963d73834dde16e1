#pragma once

#include <optional>
#include <vector>

#include "extended_model.hpp"

namespace slideway {

/// The noise of every face, noise_if_complete(), if what a model leaves is no more than slow noise
/// that each has for itself. The fine band may not show such noise: the marks of a coarse feed hide
/// it. So nothing may be left under it: no lack of fit, no profiles that disagree, no process
/// on any variable, shared or of one profile alone, and no candidate beside what every cut has. A
/// form that profiles share, or one that noise does not make, is none.
/// @return nothing, too, with an effect in the model that may not be there, with repeats, with
///         readings of the slide, and with fewer profiles than Gates::profiles_for_slow_noise
std::optional<std::vector<Noise>> noise_of_its_own(ModelExtender& extender,
                                                   const std::vector<AcceptedEffect>& effects);

}  // namespace slideway
