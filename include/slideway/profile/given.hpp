#pragma once

#include "slideway/profile/profile.hpp"

namespace slideway {

/// As read_profile(), of numbers that are there already, in the source's units; a value that is NaN
/// is a missing point. The profile's file and format are "arrays".
/// @throws DataError, UsageError  as read_profile(); a position that is not finite
void take_profile(const ProfileSource& source, const Trace& numbers, Profile& profile);

}  // namespace slideway
