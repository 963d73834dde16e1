#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "slideway/batch/batch.hpp"

namespace slideway {

/// One line of stderr that is overwritten and gone in the end; nothing where stderr is no terminal
/// that can overwrite, and nothing in the first second.
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

/// The stages of one job, each with the time since the job's beginning, which goes on by itself,
/// and from its second second on with what is left of the stage, where it says which part is done.
class StageLine {
 public:
  explicit StageLine(bool wanted);

  void show(std::string stage, double done = 0.0);

 private:
  using Seconds = std::chrono::duration<double>;
  void draw() const;

  ProgressLine line_;
  std::mutex mutex_;
  std::condition_variable_any never_;
  std::string stage_;
  Seconds began_{0.0}, told_{0.0};  // when the stage, and when the part of it that is done
  double done_ = 0.0;
  std::jthread clock_;  // the last: ends before the others do
};

/// How far a batch is: "12 of 100 items, 1 failed, 3.2 a second, 28 s left". What was there before
/// says nothing of the rate.
std::string batch_progress(const BatchSummary& so_far, std::size_t total,
                           std::chrono::duration<double> elapsed);

}  // namespace slideway
