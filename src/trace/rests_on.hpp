#pragma once

#include "extended_model.hpp"
#include "selection.hpp"

namespace slideway {

/// Names what else may have made an effect that the cuts themselves do not show at `size` of its
/// uncertainties. One that rests on readings of the slide, which it does not touch, may be an error
/// of those (errors_of_readings()); one that rests on priors may be a prior that is wrong.
void doubt_what_rests_on_others(ModelExtender& extender, Selection& selection);

}  // namespace slideway
