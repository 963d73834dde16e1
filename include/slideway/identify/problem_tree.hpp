#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "slideway/identify/problem.hpp"

/// Problems and profiles that a program has in memory, in part or altogether.
namespace slideway {

struct TomlEntry;

/// A value of a problem file with the line it stands on, 0 where there is no file. Dates and times,
/// of which a problem file has none, are std::monostate.
struct TomlValue {
  using Array = std::vector<TomlValue>;
  using Table = std::vector<TomlEntry>;

  int line = 0;
  std::variant<std::monostate, bool, std::int64_t, double, std::string, Array, Table> data;
};

struct TomlEntry {
  std::string key;
  int line = 0;
  TomlValue value;
};

/// A problem whose root table is `tree`, checked as a file is; messages call it "problem". Paths
/// are relative to the working directory, and a [[profile]] may do without `file`.
/// @throws UsageError  as read_problem(path)
Problem read_problem(const TomlValue& tree,
                     const std::optional<std::filesystem::path>& data_dir = std::nullopt);

/// The files that a problem file names (`file` of any table, `effects` of the root), as it names
/// them; none of a text that is no TOML. @throws DataError  it cannot be read
std::vector<std::string> files_named(const std::filesystem::path& problem);

/// Numbers by the name of their [[profile]], in its position_unit and value_unit.
using GivenTraces = std::map<std::string, Trace>;

/// Profiles of a problem, in order: from `given` where it has them, else from their files.
/// @throws UsageError  no [[profile]] of a given name; a profile with neither file nor numbers
/// @throws DataError   as read_profiles(problem) and take_profile()
std::vector<Profile> read_profiles(const Problem& problem, const GivenTraces& given,
                                   const ReadProgress& progress = {});

}  // namespace slideway
