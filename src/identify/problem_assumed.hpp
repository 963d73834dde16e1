#pragma once

#include <vector>

#include "problem_section.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// What the file leaves out and decides. REQUIRES a problem read from this root.
std::vector<Assumption> assumed_by(const Section& root, const Problem& problem);

}  // namespace slideway
