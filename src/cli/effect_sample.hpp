#pragma once

#include <memory>
#include <string>

#include "slideway/effects/effect.hpp"

namespace slideway {

/// An effect on the paper's lathe with its required options, for its description.
std::unique_ptr<Effect> sample_effect(const std::string& name);

}  // namespace slideway
