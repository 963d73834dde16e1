#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "slideway/batch/batch.hpp"

namespace slideway {

/// A progress line on stderr: overwritten by each show(), erased at the end. Nothing is written if
/// stderr is not a terminal, and nothing in the first second.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  [[nodiscard]] bool is_shown() const { return shown_; }
  [[nodiscard]] std::chrono::duration<double> elapsed() const { return Clock::now() - start_; }
  void show(std::string_view text) const;

 private:
  using Clock = std::chrono::steady_clock;
  bool shown_;
  Clock::time_point start_ = Clock::now();
};

/// The stage of a job with the elapsed time of the job, refreshed every second. If the stage
/// reports its progress, the remaining time of the stage follows after one second.
class StageLine {
 public:
  explicit StageLine(bool wanted);

  void show(std::string stage, double done = 0.0);

 private:
  using Seconds = std::chrono::duration<double>;
  void draw() const;

  ProgressLine line_;
  std::mutex mutex_;
  std::condition_variable_any stopped_;
  std::string stage_;
  Seconds started_{0.0}, reported_{0.0};  // start of the stage, and its last progress report
  double done_ = 0.0;
  std::jthread refresh_;  // the last member: it is joined before the others are destroyed
};

/// Progress of a batch: "12 of 100 items, 1 failed, 3.2 a second, 28 s left". The rate excludes
/// items kept from an earlier run.
std::string batch_progress(const BatchSummary& so_far, std::size_t total,
                           std::chrono::duration<double> elapsed);

}  // namespace slideway
