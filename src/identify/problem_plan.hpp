#pragma once

#include <vector>

#include "problem_profile.hpp"

namespace slideway {

/// @param tree      the root table of `file`
/// @param profiles  of the problem
/// @throws UsageError
std::vector<PlannedCut> planned_cuts_of(const std::string& file, const TomlValue& tree,
                                        const ProfileDefaults& defaults, ProblemRules rules,
                                        const std::vector<ProfileEntry>& profiles);

}  // namespace slideway
