#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "workspace.hpp"

namespace slideway {

/// Data files in a temporary folder, and what is asked and said about them.
class DraftSession {
 public:
  explicit DraftSession(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~DraftSession();
  DraftSession(const DraftSession&) = delete;
  DraftSession& operator=(const DraftSession&) = delete;

  /// @return the name the file has got  @throws HttpFailure  413: too many, too large
  std::string add(std::string_view name, std::string_view bytes);
  void remove(const std::string& name);

  /// Takes over a run: its files, wherever under `root` they are, and its problem, which then names
  /// them as they are called here. @return the problem
  std::string take(const std::filesystem::path& run, const std::filesystem::path& root);

  /// What was read, the questions of `init` with the answers of `given` (a JSON text), and the
  /// problem once none is open; as JSON.
  std::string questions(const std::string& given);

  /// What a problem's profiles hold, thinned for a plot; as JSON.
  std::string traces(const std::string& problem);

  /// Calls back with a folder in which the problem stands beside the files.
  template <typename Work>
  auto with_problem(const std::string& problem, const Work& work) {
    const std::lock_guard lock(mutex_);
    write_problem(problem);
    return work(folder_);
  }

  /// Copies the problem and the files that it names into an empty folder.
  void copy(const std::string& problem, const std::filesystem::path& folder);

 private:
  /// @throws UsageError  it names a file that is not here
  void write_problem(const std::string& problem) const;

  std::filesystem::path folder_;
  std::vector<std::string> files_;
  std::size_t bytes_ = 0;
  std::mutex mutex_;
};

/// The sessions that are open. Beyond kMostDrafts the one that was used longest ago is closed.
class Drafts {
 public:
  explicit Drafts(const Workspace& workspace) : workspace_(workspace) {}

  /// @return its id
  std::string open();
  /// @throws HttpFailure  404
  std::shared_ptr<DraftSession> at(const std::string& id);

 private:
  static constexpr std::size_t kMostDrafts = 16;

  const Workspace& workspace_;
  std::mutex mutex_;
  std::vector<std::pair<std::string, std::shared_ptr<DraftSession>>> open_;  // last used last
};

}  // namespace slideway
