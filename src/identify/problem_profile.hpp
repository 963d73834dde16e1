#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "problem_section.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {

/// What [machine] and [low_band] say that every profile takes over.
struct ProfileDefaults {
  Lever lever = Lever::paper;
  double overhang_mm = 0.0;
  double spindle_position_mm = 0.0;
  LowBandOptions low_band;
};

/// Paths of the problem file: relative to `base`, ${SLIDEWAY_DATA} replaced by `data_dir`; and
/// which parts are optional.
struct ProblemRules {
  std::filesystem::path base;
  std::optional<std::filesystem::path> data_dir;
  bool file_is_needed = true;
  bool effect_is_needed = true;
};

/// The path a key of a section gives.
std::filesystem::path resolved(const Section& section, std::string_view key, std::string file,
                               const ProblemRules& rules);

/// One [[profile]]. @throws UsageError
ProfileEntry read_profile_entry(const Section& section, const ProfileDefaults& defaults,
                                const ProblemRules& rules);

inline constexpr std::string_view kLowBandKeys = "wavelet level boundary";

/// The low band a section asks for; keys it does not have as in `defaults`.
LowBandOptions read_low_band(const Section& section, LowBandOptions defaults);

/// Refuses an overhang that the lever gives nothing to do.
void check_overhang(const Section& section, double overhang_mm, Lever lever);

}  // namespace slideway
