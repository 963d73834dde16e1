#include "output.hpp"

#include <unistd.h>

#include <cerrno>
#include <iostream>
#include <stdexcept>
#include <system_error>

#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"

namespace slideway {

void print(std::string_view text) {
  errno = 0;
  std::cout.write(text.data(), static_cast<std::streamsize>(text.size()));
  std::cout.flush();
  if (!std::cout)
    throw std::runtime_error("standard output: can not be written: " +
                             std::generic_category().message(errno != 0 ? errno : EIO));
}

void write_output(const std::string& path, std::string_view text) {
  if (path == "-")
    print(text);
  else
    write_file(path, text);
}

void keep_input(const std::filesystem::path& input, const std::filesystem::path& output) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(input, ignored) &&
      std::filesystem::equivalent(input, output, ignored))
    throw UsageError(output.string() +
                     ": is the input, which would be lost; accepted: another name");
}

ProgressLine::ProgressLine(bool wanted) : shown_(wanted && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() { show(""); }

void ProgressLine::show(std::string_view stage) const {
  constexpr std::string_view kEraseLine = "\r\033[K";
  if (shown_) std::cerr << kEraseLine << stage << std::flush;
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
