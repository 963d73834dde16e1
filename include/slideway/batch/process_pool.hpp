#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>

#include "slideway/batch/task_pool.hpp"

namespace slideway {

struct WorkerLimits {
  std::optional<std::chrono::milliseconds> time;  // for one task
  std::uint64_t memory_bytes = 0;                 // data of one worker; 0: no limit
};

/// Worker processes on this machine, forked from the caller, each with one thread. A worker that
/// crashes or exceeds its time is killed and replaced; the result of its task has no reply. The
/// workers end with the caller, also when the caller is killed.
class ProcessPool final : public TaskPool {
 public:
  using Work = std::function<std::string(const std::string& task)>;

  /// @throws std::runtime_error  the system refuses more processes or sockets
  ProcessPool(std::size_t count, Work work, const WorkerLimits& limits);
  ~ProcessPool() override;
  ProcessPool(const ProcessPool&) = delete;
  ProcessPool& operator=(const ProcessPool&) = delete;

  [[nodiscard]] bool has_idle() const override;
  void submit(std::string task) override;
  [[nodiscard]] std::size_t pending() const override;
  std::vector<TaskResult> collect(std::chrono::milliseconds timeout) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Worker {
    pid_t process = -1;
    int socket = -1;
    bool is_busy = false;
    std::string task;
    Clock::time_point deadline = Clock::time_point::max();
    std::string received;  // size and reply, as far as they have arrived
  };

  void start(Worker& worker);
  /// Kills the worker if it still runs. @return how it ended, as waitpid() has it
  static int end(Worker& worker) noexcept;
  void end_all() noexcept;
  [[noreturn]] void serve(int socket) const;
  [[nodiscard]] int poll_timeout(std::chrono::milliseconds timeout) const;
  /// Reads what has arrived. False if the worker has ended.
  static bool receive(Worker& worker);

  Work work_;
  WorkerLimits limits_;
  std::vector<Worker> workers_;
};

}  // namespace slideway
