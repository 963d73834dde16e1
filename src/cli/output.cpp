#include "output.hpp"

#include <spawn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <system_error>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/emphasis.hpp"

namespace slideway {

void print(std::string_view text) {
  errno = 0;
  std::cout.write(text.data(), static_cast<std::streamsize>(text.size()));
  std::cout.flush();
  if (!std::cout)
    throw std::runtime_error("standard output: cannot be written: " +
                             std::generic_category().message(errno != 0 ? errno : EIO));
}

void write_output(const std::string& path, std::string_view text) {
  if (path == "-")
    print(text);
  else
    write_file(path, text);
}

namespace {

void require_writable(const std::filesystem::path& output) {
  const auto refuse = [&](int error) {
    throw std::runtime_error(output.string() +
                             ": cannot be written: " + std::generic_category().message(error));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(output, ignored)) refuse(EISDIR);
  const std::filesystem::path folder = output.has_parent_path() ? output.parent_path() : ".";
  if (std::filesystem::exists(folder, ignored) && !std::filesystem::is_directory(folder, ignored))
    refuse(ENOTDIR);
  const bool is_special = std::filesystem::is_other(output, ignored) ||
                          std::filesystem::is_character_file(output, ignored);
  if (!is_special && access(folder.c_str(), W_OK) != 0) refuse(errno);
}

/// Where a file is, or will be, behind all links.
std::filesystem::path place_of(std::filesystem::path path) {
  constexpr int kMostLinks = 40;
  std::error_code ignored;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, ignored); ++i)
    path = path.parent_path() / std::filesystem::read_symlink(path, ignored);
  return std::filesystem::weakly_canonical(std::filesystem::absolute(path), ignored);
}

}  // namespace

std::string as_typed(const std::string& name) {
  constexpr std::string_view kTakenApart = " \t\n\"'\\$`&|;<>()[]{}*?!#~";
  if (name.find_first_of(kTakenApart) == std::string::npos) return name;
  std::string quoted = "'";
  for (const char c : name) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;
  return std::filesystem::equivalent(a, b, ignored) || place_of(a) == place_of(b);
}

void keep_input(const std::filesystem::path& input, const std::filesystem::path& output) {
  if (output.empty() || output == "-") return;
  std::error_code ignored;
  if (std::filesystem::is_regular_file(input, ignored) &&
      std::filesystem::equivalent(input, output, ignored))
    throw UsageError(output.string() +
                     ": is the input, which would be lost; accepted: another name");
  require_writable(output);
}

bool obeys_escapes(Stream stream) {
  const char* const terminal = std::getenv("TERM");
  return isatty(stream == Stream::out ? STDOUT_FILENO : STDERR_FILENO) == 1 &&
         terminal != nullptr && std::string_view(terminal) != "dumb";
}

// A name in a file may hold what a terminal obeys.
void print_report(const std::string& text) {
  const char* const refused = std::getenv("NO_COLOR");
  const bool coloured = (refused == nullptr || *refused == '\0') && obeys_escapes(Stream::out);
  std::string safe;
  for (std::string_view rest = text; !rest.empty();) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    safe += printable(rest.substr(0, end), end) + (end < rest.size() ? "\n" : "");
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  print(coloured ? with_emphasis(safe) : safe);
}

pid_t show_page(std::string page) {
  std::string program = "xdg-open";
  char* arguments[] = {program.data(), page.data(), nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  pid_t child = -1;
  const int error = posix_spawnp(&child, program.c_str(), nullptr, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  return error == 0 ? child : -1;
}

void say(const std::vector<std::string>& messages) {
  std::string text;
  for (std::string line : messages) {
    for (char& c : line)
      if (c == '\n' || c == '\r') c = ' ';
    text += "slideway: " + printable(line, line.size()) + "\n";
  }
  std::cerr << text << std::flush;
}

void say(std::string_view message) { say(std::vector{std::string(message)}); }

}  // namespace slideway
