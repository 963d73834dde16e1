#pragma once

#include <vector>

#include "slideway/profile/profile.hpp"

namespace slideway {

/// Notes a profile whose trace is as much longer or shorter than those of most others of its kind
/// as mm are than m, µm or inches; of two alone the second.
void note_other_position_units(std::vector<Profile>& profiles);

}  // namespace slideway
