#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/temporary_folder.hpp"

namespace slideway {

struct ProgramRun {
  int exit_code = -1;  // -1: ended by a signal
  std::string out, err;
};

struct ProgramSetup {
  std::filesystem::path folder;                         // working directory
  std::filesystem::path stdout_to;                      // instead of being captured
  std::map<std::string, std::string> environment = {};  // added; SLIDEWAY_DATA is never passed on
  int stdout_number = -1;                               // a descriptor to be stdout
  int stderr_number = -1;                               // and stderr
  int signal = 0;                                       // sent after so long
  std::chrono::microseconds signal_after{};
};

/// Runs the program as a shell would and waits for its end.
ProgramRun run_program(const std::vector<std::string>& arguments, const ProgramSetup& setup);

/// The form of a refusal: this exit code, nothing on stdout, one line on stderr.
testing::AssertionResult is_refused(const ProgramRun& run, int exit_code);

std::string contents(const std::filesystem::path& file);
std::vector<std::string> lines_of(const std::string& text);
std::vector<std::string> names_in(const std::filesystem::path& folder);

/// A file of the source tree: "problems/paper-600mm/problem.toml".
std::string shipped(const std::string& path);

/// A test that runs the program in a folder of its own.
class ProgramTest : public testing::Test {
 protected:
  [[nodiscard]] ProgramRun run(const std::vector<std::string>& arguments) const {
    return run_program(arguments, {folder_.path(), {}});
  }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }

  TemporaryFolder folder_;
};

}  // namespace slideway
