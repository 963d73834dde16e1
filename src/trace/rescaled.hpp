#pragma once

#include "slideway/profile/profile.hpp"

namespace slideway {

/// A profile with its positions in another unit; a centre in the trace and a radius of the
/// cut that was taken from it go with them.
Profile rescaled(Profile profile, double factor);

}  // namespace slideway
