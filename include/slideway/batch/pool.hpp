#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slideway/batch/manifest.hpp"
#include "slideway/identify/pooling.hpp"

/// The joint evaluation of the items of each machine (identify/pooling.hpp), from a results file.
namespace slideway {

/// The column `time` of a manifest: numbers as they are, or dates (2026-11-21, 2026-11-21T08:30,
/// 2026-11-21 08:30:00Z) in days since 1970.
struct Times {
  std::vector<std::optional<double>> values;
  bool are_dates = false;
};
/// @throws DataError  "line 3: ..." neither, or some the one and some the other
Times read_times(const Manifest& manifest);

/// Pools a results file by the manifest's column `machine`, in the order of the first item of each.
/// @throws DataError  no column `machine`; the results cannot be read
std::vector<PooledMachine> pool_machines(const Manifest& manifest,
                                         const std::filesystem::path& results);

struct PooledResults {
  std::vector<PooledMachine> machines;
  bool are_dates = false;  // of the times; numbers beside dates are no times
};

/// The same without the manifest, by the `machine` and `time` of each line: machines by name, items
/// by time, in whatever order the lines were written.
/// @throws DataError  the results cannot be read
PooledResults pool_machines(const std::filesystem::path& results);

/// The machines for people, and as a JSON array. @param are_dates  as Times has it
std::string pooled_text(const std::vector<PooledMachine>& machines, bool are_dates);
std::string pooled_json(const std::vector<PooledMachine>& machines, bool are_dates);

}  // namespace slideway
