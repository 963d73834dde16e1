#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace slideway {

/// What became of a task: what its worker said, or why that said nothing.
struct Answer {
  std::string task;
  std::optional<std::string> reply;
  std::string cause, reason;  // without a reply: status::kTimeout or status::kCrashed; in words
};

/// Those who do the work, here or elsewhere. Tasks and replies are texts that mean nothing to them.
class Hands {
 public:
  virtual ~Hands() = default;

  /// Whether somebody could begin at once.
  [[nodiscard]] virtual bool has_idle() const = 0;
  /// REQUIRES has_idle().
  virtual void give(std::string task) = 0;
  /// Tasks given whose answer is still out.
  [[nodiscard]] virtual std::size_t busy() const = 0;
  /// The answers that came in; waits for one, or until somebody becomes idle, at most so long.
  virtual std::vector<Answer> wait(std::chrono::milliseconds longest) = 0;
};

}  // namespace slideway
