#pragma once

#include <vector>

#include "problem_profile.hpp"
#include "problem_section.hpp"
#include "slideway/effects/channel.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// [[channel]], with what is in the files.
/// @throws UsageError, DataError
std::vector<Channel> read_channels(const Section& root, const ProblemRules& rules,
                                   Problem& problem);

}  // namespace slideway
