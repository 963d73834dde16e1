#pragma once

#include <chrono>
#include <filesystem>
#include <list>
#include <mutex>
#include <string>
#include <thread>

#include "draft_session.hpp"
#include "slideway/serve/serve.hpp"
#include "workspace.hpp"

namespace slideway {

/// Runs of `identify`, each in a process and a temporary folder of its own, which becomes a run
/// when it is whole.
class Jobs {
 public:
  Jobs(const Workspace& workspace, const ServeOptions& options)
      : workspace_(workspace), options_(options) {}

  /// @return its id  @throws HttpFailure  429: as many run as may
  std::string start(DraftSession& draft, const std::string& problem, const std::string& name);

  /// How it stands, as JSON. @throws HttpFailure  404
  std::string state(const std::string& id);
  void cancel(const std::string& id);

 private:
  static constexpr std::size_t kMostJobs = 64;  // that are remembered

  using Clock = std::chrono::steady_clock;
  struct Job {
    std::string id, state = "running", progress = {}, message = {}, run = {};
    Clock::time_point started = Clock::now(), ended = {};
    std::jthread thread = {};
  };

  Job& at(const std::string& id);
  void work(Job& job, const std::stop_token& stop, const std::filesystem::path& folder,
            const std::string& name);
  void finish(Job& job, const std::string& state, const std::string& text);

  const Workspace& workspace_;
  const ServeOptions& options_;
  std::mutex mutex_;
  std::list<Job> jobs_;  // the last member: its threads use the others
};

}  // namespace slideway
