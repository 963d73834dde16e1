#pragma once

#include <deque>

#include "slideway/batch/task_pool.hpp"
#include "slideway/batch/transport.hpp"

namespace slideway {

/// The dispatcher of rank 0: its local pool and those of all other ranks. The other ranks request
/// tasks; each is sent to a rank that has requested one.
class DistributedPool final : public TaskPool {
 public:
  DistributedPool(TaskPool& local, Transport& transport);
  /// Stops the other ranks and waits until they have stopped.
  ~DistributedPool() override;
  DistributedPool(const DistributedPool&) = delete;
  DistributedPool& operator=(const DistributedPool&) = delete;

  [[nodiscard]] bool has_idle() const override;
  void submit(std::string task) override;
  [[nodiscard]] std::size_t pending() const override;
  std::vector<TaskResult> collect(std::chrono::milliseconds timeout) override;

 private:
  TaskPool* local_;
  Transport* transport_;
  std::deque<int> requests_;  // ranks, once for each task requested
  std::size_t remote_ = 0;    // tasks sent to other ranks and not yet answered
};

/// The loop of every other rank: requests tasks, runs them in `local`, sends the results, until
/// rank 0 stops it.
/// @param prefetch  tasks requested ahead; one more than `local` has workers hides the latency
void serve_tasks(TaskPool& local, Transport& transport, std::size_t prefetch);

}  // namespace slideway
