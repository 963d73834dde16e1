#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace slideway {

struct ServeOptions {
  std::filesystem::path folder = ".";                   // of the runs
  int port = 0;                                         // 0: one that is free
  std::filesystem::path program = "/proc/self/exe";     // runs `check PROBLEM`, `identify PROBLEM`
  std::chrono::seconds time = std::chrono::hours(1);    // of a run
  std::uint64_t memory_bytes = std::uint64_t{4} << 30;  // of a run
  std::size_t runs = 2;                                 // at a time
};

/// A page on this machine for the way from a data file to a report: docs/serve.md.
class PageServer {
 public:
  /// Takes the folder and the port, and removes what a server that was killed has left.
  /// @throws UsageError          another server has the folder; the port is taken
  /// @throws std::runtime_error  the folder cannot be written
  explicit PageServer(const ServeOptions& options);
  ~PageServer();
  PageServer(const PageServer&) = delete;
  PageServer& operator=(const PageServer&) = delete;

  /// Where the page is, with the token that everything is asked by.
  [[nodiscard]] std::string address() const;

  /// Answers until stop(), which may be called from another thread and ends all runs.
  void run();
  void stop();

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace slideway
