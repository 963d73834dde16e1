#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "slideway/identify/problem.hpp"

namespace slideway {

/// Makes the profiles of a problem's [truth]: the declared effects with the true parameters (0
/// where none is given), the hidden effects, white or correlated noise (one random stream per
/// profile). Positions come from the profile's file where it exists, else from `window`, else from
/// cut_radius_mm about center_mm; truth.samples of them.
/// @throws UsageError  no [truth], an unknown parameter name, no way to tell the positions
std::vector<Profile> simulate(const Problem& problem);

/// simulate(), then one CSV per profile (named as the profile) and `problem.toml` without [truth]
/// into `directory`, which is made if missing.
void write_simulation(const Problem& problem, const std::filesystem::path& directory);

}  // namespace slideway
