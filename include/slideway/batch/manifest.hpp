#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "slideway/identify/override.hpp"

namespace slideway {

/// One line of a manifest: a problem to identify.
struct ManifestItem {
  std::string id;
  std::size_t line = 0;           // of the manifest
  std::filesystem::path problem;  // relative to the manifest's folder, as read_problem() wants it
  std::vector<Override> overrides;
  std::string machine, time;  // empty where the manifest has no such column
};

struct Manifest {
  std::filesystem::path path;
  std::vector<ManifestItem> items;
};

/// Part `index` of `count`, from 1: the items whose id has index - 1 as the remainder of the first
/// 8 bytes of its SHA-256, taken as one big-endian number, divided by count.
struct Shard {
  std::size_t index = 1, count = 1;
  [[nodiscard]] bool holds(const std::string& id) const;
};

/// Reads a manifest, delimited text with a header line (format/rows.hpp): a column `problem`; `id`,
/// without which the problem's path is the id; `machine` and `time` for a joint evaluation; every
/// other column is named after a key of the problem file (identify/override.hpp) and overrides it
/// in the rows where it is not empty.
/// @throws DataError  "path: line 3: what is wrong": also no item, an id twice, an unknown column
Manifest read_manifest(const std::filesystem::path& path);

/// The same from its bytes; messages start with "line 3: ".
Manifest parse_manifest(std::string_view bytes, const std::filesystem::path& path);

}  // namespace slideway
