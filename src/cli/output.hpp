#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// Writes to stdout and flushes it.
/// @throws std::runtime_error  the disk is full, the pipe is closed
void print(std::string_view text);

/// Writes a file, or stdout if the path is "-". @throws std::runtime_error
void write_output(const std::string& path, std::string_view text);

/// Looks at where an output goes before the work is done.
/// @throws UsageError          it would replace the input
/// @throws std::runtime_error  it cannot be written: its folder is missing, it is a folder
void keep_input(const std::filesystem::path& input, const std::filesystem::path& output);

/// Whether two names are of one file, which need not be there yet.
bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// A file's name as it is typed: in quotes where a shell would take it apart.
std::string as_typed(const std::string& name);

enum class Stream { out, err };

/// Whether a stream ends in a terminal that obeys escape sequences.
bool obeys_escapes(Stream stream);

/// print() of a text without control characters, with coloured headings and verdicts if stdout is a
/// terminal and NO_COLOR is not set (no-color.org).
void print_report(const std::string& text);

/// Starts xdg-open of a page, in a process group of its own and with no signal blocked.
/// @return its process; -1: there is no such program
pid_t show_page(std::string page);

/// A message of one line on stderr: "slideway: ...".
void say(std::string_view message);
/// All of these, or none.
void say(const std::vector<std::string>& messages);

}  // namespace slideway
