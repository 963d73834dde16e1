#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/problem.hpp"

/// Cuts and traces that a problem file plans ([[plan.cut]]), and problem files made of them.
namespace slideway {

/// One [[plan.cut]]: a cut or trace that can be made next.
struct PlannedCut {
  ProfileEntry entry;       // without a file; what it leaves out is that of `like`
  std::string like;         // a profile of its kind and quantity; empty: there is none
  std::size_t samples = 0;  // evenly spaced in the window; 0: as close as those of `like`
  std::optional<double> cost, time_min;
};

/// The [[plan.cut]] tables of a problem file, in order. A key that one leaves out is that of the
/// profile it names by `like`, else of the first profile of its kind and quantity.
/// @throws UsageError  as read_problem()
std::vector<PlannedCut> read_planned_cuts(
    const std::filesystem::path& path,
    const std::optional<std::filesystem::path>& data_dir = std::nullopt);

/// The problem file without [plan] and [truth], to be put into another directory: relative paths
/// lead from there to where they lead now.
/// @throws UsageError  the problem file can no longer be read
std::string moved_problem_text(const Problem& problem, const std::filesystem::path& directory);

}  // namespace slideway
