#pragma once

#include <memory>
#include <string>

#include "slideway/effects/effect.hpp"

namespace slideway {

/// An effect to look at: on the paper's lathe, with what it cannot do without.
std::unique_ptr<Effect> sample_effect(const std::string& name);

}  // namespace slideway
