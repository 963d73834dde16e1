#pragma once

#include <cstddef>

#include "slideway/profile/profile.hpp"

namespace slideway {

/// The profile as means of `count` neighbouring samples at the mean of their positions; a gap
/// starts a new mean. The standard uncertainty of a sample becomes that of a mean of independent
/// ones. REQUIRES count >= 1
Profile means_of(const Profile& profile, std::size_t count);

}  // namespace slideway
