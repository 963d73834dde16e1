#include "output.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <system_error>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
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

}  // namespace

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

void print_report(const std::string& text) {
  const char* const refused = std::getenv("NO_COLOR");
  const bool coloured = (refused == nullptr || *refused == '\0') && obeys_escapes(Stream::out);
  print(coloured ? with_emphasis(text) : text);
}

void say(std::string_view message) {
  std::string line = "slideway: " + std::string(message);
  for (char& c : line)
    if (c == '\n' || c == '\r')
      c = ' ';
    else if ((c >= 0 && c < ' ') || c == 0x7f)
      c = '?';  // a name may hold what a terminal obeys
  std::cerr << line << std::endl;
}

}  // namespace slideway
