#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace slideway {

/// The outcome of a task: its reply, or why there is none.
struct TaskResult {
  std::string task;
  std::optional<std::string> reply;
  std::string cause, reason;  // without a reply: status::kTimeout or status::kCrashed; in words
};

/// Runs tasks in other processes, on this machine or on several. Tasks and replies are opaque
/// texts.
class TaskPool {
 public:
  virtual ~TaskPool() = default;

  /// Whether a worker is idle, or has asked for a task.
  [[nodiscard]] virtual bool has_idle() const = 0;
  /// REQUIRES has_idle().
  virtual void submit(std::string task) = 0;
  /// Number of tasks submitted and not yet collected.
  [[nodiscard]] virtual std::size_t pending() const = 0;
  /// Results that have arrived. Blocks until there is one, a worker becomes idle, or the timeout.
  virtual std::vector<TaskResult> collect(std::chrono::milliseconds timeout) = 0;
};

}  // namespace slideway
