#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// A command of the program in a process of its own, in a folder that is its working directory.
struct WorkerTask {
  std::filesystem::path program, folder;
  std::vector<std::string> arguments;
  std::chrono::seconds time{60};
  std::uint64_t memory_bytes = 0;
  bool shows_progress = false;  // stderr is a terminal and is the text; else stdout is
};

struct WorkerEnd {
  int exit_code = -1;  // -1: it did not end by itself
  std::string text;    // the last of what it wrote
  std::string cause;   // why it did not end by itself: "cancelled", "took longer than 60 s"
};

/// Runs to the end; a stop, or the end of the time, kills the process with all that it started.
/// @param told  gets what it has written so far, as it comes
WorkerEnd run_worker(const WorkerTask& task, const std::stop_token& stop,
                     const std::function<void(std::string_view)>& told = {});

}  // namespace slideway
