#pragma once

#include <optional>
#include <vector>

#include "slideway/identify/result.hpp"
#include "slideway/profile/profile.hpp"

namespace slideway {

/// close_lines() for the report.
std::optional<ClosureSummary> summarise_closure(const std::vector<Profile>& profiles);

}  // namespace slideway
