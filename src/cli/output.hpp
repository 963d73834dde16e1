#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace slideway {

/// Writes to stdout and makes sure that it arrived.
/// @throws std::runtime_error  the disk is full, the pipe is closed
void print(std::string_view text);

/// Writes a file, or stdout if the path is "-". @throws std::runtime_error
void write_output(const std::string& path, std::string_view text);

/// @throws UsageError  the output would replace the input
void keep_input(const std::filesystem::path& input, const std::filesystem::path& output);

/// What the program is at, on one line of stderr that is overwritten and gone in the end; nothing
/// where stderr is no terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(std::string_view stage) const;

 private:
  bool shown_;
};

/// A message for people, one line on stderr: "slideway: ...".
void say(std::string_view message);

}  // namespace slideway
