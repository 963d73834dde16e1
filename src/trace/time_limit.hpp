#pragma once

#include <chrono>
#include <optional>
#include <utility>

namespace slideway {

/// Thrown where the time of the loop is up; caught by TimeLimit::allows().
struct TimeIsUp {};

/// The time a closed loop may take, from its construction; none: as long as it needs.
class TimeLimit {
 public:
  explicit TimeLimit(std::optional<double> seconds) {
    if (seconds)
      end_ = Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*seconds));
  }

  /// Does work that may be left out. @return false if the time was up before it was done
  template <typename Work>
  bool allows(Work&& work) {
    is_enforced_ = true;
    try {
      check();
      std::forward<Work>(work)();
    } catch (const TimeIsUp&) {
      return is_enforced_ = false;
    }
    is_enforced_ = false;
    return true;
  }

  /// Before each part of what may be left out. @throws TimeIsUp
  void check() const {
    if (is_enforced_ && end_ && Clock::now() >= *end_) throw TimeIsUp();
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<Clock::time_point> end_;
  bool is_enforced_ = false;
};

}  // namespace slideway
