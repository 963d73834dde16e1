#include "progress.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>

#include "output.hpp"
#include "slideway/base/text.hpp"
#include "slideway/report/number.hpp"

namespace slideway {
namespace {

constexpr std::chrono::seconds kInterval{1};

/// "28 s", "3 min 20 s", "2 h 5 min".
std::string in_words(std::chrono::duration<double> time) {
  const auto seconds = static_cast<long>(std::min(std::ceil(time.count()), 3.6e9));
  if (seconds < 60) return std::to_string(seconds) + " s";
  if (seconds < 3600)
    return std::to_string(seconds / 60) + " min " + std::to_string(seconds % 60) + " s";
  return std::to_string(seconds / 3600) + " h " + std::to_string(seconds % 3600 / 60) + " min";
}

std::string rate_in_words(double per_second) {
  for (const auto& [unit, seconds] : {std::pair{"second", 1.0}, {"minute", 60.0}})
    if (per_second * seconds >= 1.0) return significant(per_second * seconds, 2) + " a " + unit;
  return significant(per_second * 3600.0, 2) + " an hour";
}

}  // namespace

ProgressLine::ProgressLine(bool wanted) : shown_(wanted && obeys_escapes(Stream::err)) {}

ProgressLine::~ProgressLine() { show(""); }

void ProgressLine::show(std::string_view text) const {
  constexpr std::string_view kEraseLine = "\r\033[K";
  if (shown_ && elapsed() >= kInterval) std::cerr << kEraseLine << text << std::flush;
}

StageLine::StageLine(bool wanted) : line_(wanted) {
  if (!line_.is_shown()) return;
  refresh_ = std::jthread([this](const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      stopped_.wait_for(lock, stop, kInterval, [] { return false; });
      if (!stop.stop_requested()) draw();
    }
  });
}

void StageLine::show(std::string stage, double done) {
  const std::lock_guard lock(mutex_);
  const bool is_new = stage != stage_;
  stage_ = std::move(stage);
  reported_ = line_.elapsed();
  done_ = done;
  if (!is_new) return;
  started_ = reported_;
  draw();
}

void StageLine::draw() const {
  std::string text = stage_ + ", " + in_words(line_.elapsed());
  const Seconds taken = reported_ - started_;
  const Seconds left = taken * ((1.0 - done_) / done_) - (line_.elapsed() - reported_);
  if (done_ > 0.0 && taken >= kInterval && left > Seconds(0.0))
    text += ", this step about " + in_words(left) + " more";
  line_.show(text);
}

std::string batch_progress(const BatchSummary& so_far, std::size_t total,
                           std::chrono::duration<double> elapsed) {
  const std::size_t done = all_of(so_far.counts), failed = failed_of(so_far.counts);
  std::string text = std::to_string(done) + " of " + counted(total, "item");
  if (failed > 0) text += ", " + std::to_string(failed) + " failed";
  if (done == so_far.present) return text;
  const double rate = static_cast<double>(done - so_far.present) / elapsed.count();
  text += ", " + rate_in_words(rate);
  if (done == total) return text;
  const std::chrono::duration<double> left(static_cast<double>(total - done) / rate);
  return text + ", " + in_words(left) + " left";
}

}  // namespace slideway
