#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

/// The TOML library stays behind this header: it costs seconds for every file that includes it.
namespace slideway {

struct TomlEntry;

/// A value of a TOML file with the line it stands on. Dates and times, of which a problem file has
/// none, are std::monostate.
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

/// The root table of a TOML file.
/// @throws UsageError  "path: ..." if it can not be read, "path:line: ..." if it is no TOML
TomlValue read_toml(const std::filesystem::path& path);

/// What a text is in TOML, on line 0: std::monostate if it is no value, or a date.
TomlValue toml_value(const std::string& text);

}  // namespace slideway
