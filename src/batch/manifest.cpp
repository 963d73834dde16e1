#include "slideway/batch/manifest.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <unordered_map>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/rows.hpp"

namespace slideway {
namespace {

[[noreturn]] void refuse(std::size_t line, const std::string& what) {
  throw DataError("line " + std::to_string(line) + ": " + what);
}

/// A key of the problem file has a dot, but for the title.
void check_columns(const std::vector<std::string>& names, std::size_t line) {
  const std::vector<std::string> known{"id", "problem", "title", "machine", "time"};
  for (const std::string& name : names) {
    if (name.find('.') != std::string::npos) continue;
    if (std::find(known.begin(), known.end(), name) == known.end())
      refuse(line, "unknown column '" + printable(name) + "'" + did_you_mean(name, known) +
                       "; accepted: " + joined(known, " ") +
                       " and keys of the problem file, as low_band.level or profile.NAME.file");
  }
  if (std::find(names.begin(), names.end(), "problem") == names.end())
    refuse(line, "no column 'problem'; accepted: id problem and keys of the problem file");
}

ManifestItem item_of(const TextRows& table, const TextRows::Row& row,
                     const std::filesystem::path& folder) {
  ManifestItem item;
  item.line = row.line;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string& name = table.names[i];
    const std::string& field = row.fields[i];
    if (printable(field, field.size()) != field)
      refuse(row.line, "column '" + printable(name, 40) + "': '" + printable(field) +
                           "' holds control characters");
    if (field.empty() && (name == "id" || name == "problem"))
      refuse(row.line, "column '" + name + "' is empty");
    if (name == "id")
      item.id = field;
    else if (name == "problem")
      item.problem = folder / field;
    else if (name == "machine")
      item.machine = field;
    else if (name == "time")
      item.time = field;
    else if (!field.empty())
      item.overrides.push_back({name, field});
    if (name == "problem" && item.id.empty()) item.id = field;
  }
  return item;
}

}  // namespace

bool Shard::holds(const std::string& id) const {
  const std::string digits = sha256(id).substr(0, 16);
  std::uint64_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
  return number % count == index - 1;
}

Manifest parse_manifest(std::string_view bytes, const std::filesystem::path& path) {
  if (bytes.empty()) throw DataError("is empty");
  const TextRows table = parse_rows(bytes);
  check_columns(table.names, table.line);
  Manifest out{path, {}};
  std::unordered_map<std::string, std::size_t> lines;  // by id
  const bool has_id = std::find(table.names.begin(), table.names.end(), "id") != table.names.end();
  for (const TextRows::Row& row : table.rows) {
    out.items.push_back(item_of(table, row, path.parent_path()));
    const std::string& id = out.items.back().id;
    const auto [first, is_new] = lines.emplace(id, row.line);
    if (!is_new)
      refuse(row.line, "id '" + printable(id, 60) + "' is that of line " +
                           std::to_string(first->second) +
                           (has_id ? "; accepted: one of its own"
                                   : "; give a column 'id' where a problem is there twice"));
  }
  if (out.items.empty()) throw DataError("lists no problems");
  return out;
}

Manifest read_manifest(const std::filesystem::path& path) {
  const FileBytes bytes = FileBytes::of_file_or_stdin(path);
  try {
    return parse_manifest(bytes.text(), path);
  } catch (const DataError& error) {
    throw DataError(path.string() + ": " + error.what());
  }
}

}  // namespace slideway
