#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>

#include "slideway/batch/hands.hpp"

namespace slideway {

struct WorkerLimits {
  std::optional<std::chrono::milliseconds> time;  // for one task
  std::uint64_t memory_bytes = 0;  // of one worker's own data; 0: what the system has
};

/// Worker processes on this machine, forked from the caller, each doing one task after the other in
/// one thread. One that crashes or takes too long is ended and replaced; what it was doing is
/// answered without a reply. They end with the caller, however that ends.
class Workers final : public Hands {
 public:
  using Work = std::function<std::string(const std::string& task)>;

  /// @throws std::runtime_error  the system gives no more processes
  Workers(std::size_t count, Work work, const WorkerLimits& limits);
  ~Workers() override;
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] bool has_idle() const override;
  void give(std::string task) override;
  [[nodiscard]] std::size_t busy() const override;
  std::vector<Answer> wait(std::chrono::milliseconds longest) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Worker {
    pid_t process = -1;
    int socket = -1;
    bool is_busy = false;
    std::string task;
    Clock::time_point deadline = Clock::time_point::max();
    std::string received;  // of the reply, with its size in front
  };

  void start(Worker& worker);
  /// Ends it if it has not ended; in words, how it did.
  static std::string end(Worker& worker);
  [[noreturn]] void work_at(int socket) const;
  [[nodiscard]] int patience(std::chrono::milliseconds longest) const;
  /// Takes what has come in. False when the worker is gone.
  static bool receive(Worker& worker);

  Work work_;
  WorkerLimits limits_;
  std::vector<Worker> workers_;
};

}  // namespace slideway
