#pragma once

#include <filesystem>

#include "slideway/identify/problem_tree.hpp"

/// The TOML library stays behind this header: it costs seconds for every file that includes it.
namespace slideway {

/// The root table of a TOML file.
/// @param may_wait  for the end of a pipe or a device, which may never come
/// @throws UsageError  "path: ..." if it cannot be read, "path:line: ..." if it is no TOML
TomlValue read_toml(const std::filesystem::path& path, bool may_wait = false);

/// What a text is in TOML, on line 0: std::monostate if it is no value, or a date.
TomlValue toml_value(const std::string& text);

}  // namespace slideway
