#include "problem_toml.hpp"

#include <algorithm>
#include <locale>
#include <sstream>

#include <toml++/toml.h>

#include "problem_section.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"
#include "slideway/identify/problem.hpp"

namespace slideway {
namespace {

int line_of(const toml::source_region& region) { return static_cast<int>(region.begin.line); }

TomlValue converted(const toml::node& node) {
  TomlValue value{line_of(node.source()), {}};
  if (const auto* table = node.as_table()) {
    TomlValue::Table entries;
    for (const auto& [key, child] : *table)
      entries.push_back({std::string(key.str()), line_of(key.source()), converted(child)});
    value.data = std::move(entries);
  } else if (const auto* array = node.as_array()) {
    TomlValue::Array elements;
    for (const toml::node& child : *array) elements.push_back(converted(child));
    value.data = std::move(elements);
  } else if (const auto* text = node.as_string()) {
    value.data = text->get();
  } else if (const auto* integer = node.as_integer()) {
    value.data = integer->get();
  } else if (const auto* number = node.as_floating_point()) {
    value.data = number->get();
  } else if (const auto* flag = node.as_boolean()) {
    value.data = flag->get();
  }
  return value;
}

toml::table parsed(const std::filesystem::path& path, bool may_wait = false) {
  try {
    const FileBytes bytes = may_wait ? FileBytes(path) : FileBytes::of_file_or_stdin(path);
    return toml::parse(bytes.text(), path.string());
  } catch (const DataError& error) {
    throw FaultError({.message = error.what()});
  } catch (const toml::parse_error& error) {
    std::string what(error.description());
    std::replace(what.begin(), what.end(), '\n', ' ');
    const int line = line_of(error.source());
    throw FaultError({.message = path.string() + ":" + std::to_string(line) +
                                 ": no valid TOML: " + printable(what, what.size()),
                      .file = path.string(),
                      .line = line});
  }
}

void add_files(const toml::node& node, std::vector<std::string>& files) {
  if (const toml::table* table = node.as_table()) {
    if (const auto file = (*table)["file"].value<std::string>()) files.push_back(*file);
    for (const auto& [key, child] : *table) add_files(child, files);
  } else if (const toml::array* array = node.as_array()) {
    for (const toml::node& child : *array) add_files(child, files);
  }
}

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

/// A path of the problem file as a file in another directory has it.
void lead_from(const std::filesystem::path& directory, const std::filesystem::path& base,
               toml::node& node) {
  toml::value<std::string>* const path = node.as_string();
  if (path == nullptr || path->get().find("${") != std::string::npos ||
      std::filesystem::path(path->get()).is_absolute())
    return;
  path->get() =
      std::filesystem::proximate(std::filesystem::absolute(base / path->get()).lexically_normal(),
                                 std::filesystem::absolute(directory).lexically_normal())
          .generic_string();
}

void point_to_simulation(toml::table& table, const ProfileEntry& entry, const std::string& file) {
  const bool slope = entry.profile.setup.quantity == Quantity::slope;
  const std::string value_unit = slope ? "urad" : "um";
  table.insert_or_assign("file", file);
  table.insert_or_assign("position_column", "x_mm");
  table.insert_or_assign("position_unit", "mm");
  table.insert_or_assign("value_column", slope ? "slope_urad" : "z_um");
  table.insert_or_assign("value_unit", value_unit);
  if (!entry.source.time_unit.empty()) {
    table.insert_or_assign("time_column", "t_s");
    table.insert_or_assign("time_unit", "s");
  }
  for (const char* key :
       {"window", "mask", "leave_out", "delimiter", "decimal", "encoding", "header_lines", "line"})
    table.erase(key);
  if (entry.profile.standard_uncertainty && entry.source.value_unit != value_unit)
    table.insert_or_assign("standard_uncertainty",
                           *entry.profile.standard_uncertainty * (slope ? 1e6 : 1e3));
}

}  // namespace

TomlValue read_toml(const std::filesystem::path& path, bool may_wait) {
  return converted(parsed(path, may_wait));
}

TomlValue toml_value(const std::string& text) {
  // Most texts are none, and being refused takes the parser long.
  const bool may_be_one =
      text.find_first_of("#\n\r") == std::string::npos && !text.empty() &&
      std::string_view("0123456789+-.[\"'tfin").find(text[0]) != std::string_view::npos;
  if (!may_be_one) return {};
  try {
    TomlValue value = converted(*toml::parse("value = " + text).get("value"));
    value.line = 0;
    return value;
  } catch (const toml::parse_error&) {
    return {};
  }
}

std::string simulated_problem_text(const Problem& problem, const std::vector<std::string>& files) {
  toml::table root = parsed(problem.path);
  root.erase("truth");
  toml::array* profiles = root["profile"].as_array();
  if (profiles == nullptr || profiles->size() != files.size() ||
      problem.profiles.size() != files.size())
    throw UsageError(problem.path.string() + ": changed while it was being simulated");
  for (std::size_t i = 0; i < files.size(); ++i)
    if (toml::table* table = profiles->get(i)->as_table())
      point_to_simulation(*table, problem.profiles[i], files[i]);
  if (toml::array* paths = root["effects"].as_array())
    for (std::size_t i = 0; i < paths->size(); ++i)
      if (const auto* path = paths->get(i)->as_string())
        paths->replace(paths->cbegin() + static_cast<std::ptrdiff_t>(i), file_name(path->get()));
  if (toml::array* channels = root["channel"].as_array())
    for (toml::node& node : *channels)
      if (toml::table* table = node.as_table())
        table->insert_or_assign("file", file_name((*table)["file"].value_or("")));
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << root << '\n';
  return text.str();
}

std::vector<std::string> files_named(const std::filesystem::path& problem) {
  std::vector<std::string> files;
  const FileBytes bytes = FileBytes::of_file_or_stdin(problem);
  try {
    const toml::table root = toml::parse(bytes.text());
    add_files(root, files);
    if (const toml::array* paths = root["effects"].as_array())
      for (const toml::node& path : *paths)
        if (const auto file = path.value<std::string>()) files.push_back(*file);
  } catch (const toml::parse_error&) {
    return {};
  }
  return files;
}

std::string moved_problem_text(const Problem& problem, const std::filesystem::path& directory) {
  toml::table root = parsed(problem.path);
  root.erase("truth");
  root.erase("plan");
  const std::filesystem::path base = problem.path.parent_path();
  for (const char* key : {"profile", "channel"})
    if (toml::array* tables = root[key].as_array())
      for (toml::node& node : *tables)
        if (toml::table* table = node.as_table())
          if (toml::node* file = table->get("file")) lead_from(directory, base, *file);
  if (toml::array* paths = root["effects"].as_array())
    for (toml::node& path : *paths) lead_from(directory, base, path);
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << root << '\n';
  return text.str();
}

}  // namespace slideway
