#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "slideway/profile/setup.hpp"

namespace slideway {

enum class Role {
  fit,
  holdout  // never fitted, only predicted
};

/// One measured profile, ready for use: positions in mm, strictly increasing; values in mm
/// (heights) or rad (slopes). The two have the same length.
struct Profile {
  std::string name;
  std::string file;    // as the problem names it
  std::string sha256;  // of the file's bytes
  Setup setup;
  Role role = Role::fit;
  std::vector<double> positions;
  std::vector<double> values;
  bool free_offset = true;  // what levelling left undetermined: nuisances of this profile
  bool free_tilt = true;
  std::optional<double> standard_uncertainty;  // of one sample, mm or rad
  std::vector<std::string> notes;              // what was done to the data on the way in

  [[nodiscard]] Stations stations(const Machine& machine) const {
    return {positions, setup, machine};
  }
};

/// How to get a profile out of a file: what the problem file says of it, units already known.
struct ProfileSource {
  std::filesystem::path path;
  std::string position_column = "1";  // header name or 1-based number
  std::string value_column = "2";
  UnitScale position_unit;                          // to mm, or to s if the abscissa is time
  bool position_is_time = false;                    // then position = time * feed_mm_per_min
  UnitScale value_unit;                             // to mm or rad
  std::optional<std::pair<double, double>> window;  // in the file's position unit
};

/// Reads, converts and sorts out one profile: window applied, a trace that runs backwards reversed
/// (noted), cut_radius_mm completed.
/// @throws DataError  naming file and row: unsorted or repeated positions, text or NaN where a
/// number
///                    belongs, a column that is not there (the ones that are get listed), too few
///                    rows
void read_profile(const ProfileSource& source, Profile& profile);

}  // namespace slideway
