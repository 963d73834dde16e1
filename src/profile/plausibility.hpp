#pragma once

#include "slideway/profile/profile.hpp"

namespace slideway {

// Doubts sizes that no workshop has: a unit or a digit is more likely wrong. Of the readings, and
// of the setup. REQUIRES positions, and for the setup first_mm, last_mm and cut_radius_mm.
void note_implausible_values(Profile& profile);
void note_implausible_setup(Profile& profile);

}  // namespace slideway
