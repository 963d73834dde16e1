#pragma once

#include "slideway/profile/profile.hpp"

namespace slideway {

// Doubts sizes that no workshop has: a unit or a digit is more likely wrong. REQUIRES a read
// profile.
void note_implausible(Profile& profile);

}  // namespace slideway
