#pragma once

#include <vector>

#include "slideway/profile/profile.hpp"

namespace slideway {

/// Holds out every fitted profile that is a copy of one before it, so that a reading counts once;
/// notes of both profiles say so.
///
/// A copy has the same stations from the spindle axis or the origin, and after levelling (a height
/// by offset and tilt, a slope by its zero) the same values to the rounding of the two files: the
/// least difference between two values of either. Two readings of one surface differ by the
/// instrument's noise. So that a coarse display is not taken for a copy, the values must scatter
/// from station to station by many of those roundings, unless the two files are one and the same.
void hold_out_copies(std::vector<Profile>& profiles);

}  // namespace slideway
