#pragma once

#include <filesystem>
#include <optional>

#include "problem_section.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// What [machine] says that every profile takes over.
struct MachineDefaults {
  Lever lever = Lever::paper;
  double overhang_mm = 0.0;
  double spindle_position_mm = 0.0;
};

/// Paths of the problem file: relative to `base`, ${SLIDEWAY_DATA} replaced by `data_dir`; and
/// which parts are optional.
struct ProblemRules {
  std::filesystem::path base;
  std::optional<std::filesystem::path> data_dir;
  bool file_is_needed = true;
  bool effect_is_needed = true;
};

/// One [[profile]]. @throws UsageError
ProfileEntry read_profile_entry(const Section& section, const MachineDefaults& machine,
                                const ProblemRules& rules);

/// Refuses an overhang that the lever gives nothing to do.
void check_overhang(const Section& section, double overhang_mm, Lever lever);

}  // namespace slideway
