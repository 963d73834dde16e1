#include "jobs.hpp"

#include <algorithm>
#include <exception>

#include "http_server.hpp"
#include "json_text.hpp"
#include "slideway/base/text.hpp"
#include "worker.hpp"

namespace slideway {
namespace {

/// The last line that a program has written on a terminal, which it may have begun anew.
std::string last_line(std::string_view text) {
  constexpr std::string_view kEraseLine = "\r\033[K", kName = "slideway: ";
  if (const std::size_t at = text.rfind(kEraseLine); at != std::string_view::npos)
    text.remove_prefix(at + kEraseLine.size());
  text = trimmed(text);
  if (const std::size_t at = text.rfind('\n'); at != std::string_view::npos)
    text.remove_prefix(at + 1);
  if (text.starts_with(kName)) text.remove_prefix(kName.size());
  return std::string(text);
}

}  // namespace

std::string Jobs::start(DraftSession& draft, const std::string& problem, const std::string& name) {
  const std::lock_guard lock(mutex_);
  const auto running = std::ranges::count(jobs_, "running", &Job::state);
  if (std::cmp_greater_equal(running, options_.runs))
    throw HttpFailure(429, counted(options_.runs, "run") + " at a time; wait or cancel one");
  const std::filesystem::path folder = workspace_.temporary();
  try {
    draft.copy(problem, folder);
  } catch (...) {
    std::filesystem::remove_all(folder);
    throw;
  }
  if (jobs_.size() >= kMostJobs)
    jobs_.erase(std::ranges::find_if(jobs_, [](const Job& job) { return job.state != "running"; }));
  Job& job = jobs_.emplace_back(Job{.id = folder.filename().string()});
  job.thread = std::jthread(
      [this, &job, folder, name](const std::stop_token& stop) { work(job, stop, folder, name); });
  return job.id;
}

void Jobs::work(Job& job, const std::stop_token& stop, const std::filesystem::path& folder,
                const std::string& name) {
  try {
    const WorkerEnd end = run_worker({.program = options_.program,
                                      .folder = folder,
                                      .arguments = {"identify", run_file::kProblem, "--json",
                                                    run_file::kResult, "--html", run_file::kPage},
                                      .time = options_.time,
                                      .memory_bytes = options_.memory_bytes,
                                      .shows_progress = true},
                                     stop, [&](std::string_view text) {
                                       const std::lock_guard lock(mutex_);
                                       job.progress = last_line(text);
                                     });
    if (end.exit_code == 0)
      finish(job, "done", workspace_.publish(folder, name));
    else if (stop.stop_requested())
      finish(job, "cancelled", "");
    else
      finish(job, "failed", end.cause.empty() ? last_line(end.text) : end.cause);
  } catch (const std::exception& error) {
    finish(job, "failed", error.what());
  }
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
}

void Jobs::finish(Job& job, const std::string& state, const std::string& text) {
  const std::lock_guard lock(mutex_);
  (state == "done" ? job.run : job.message) = text;
  job.state = state;
  job.ended = Clock::now();
}

Jobs::Job& Jobs::at(const std::string& id) {
  const auto found = std::ranges::find(jobs_, id, &Job::id);
  if (found == jobs_.end()) throw HttpFailure(404, "no such run");
  return *found;
}

std::string Jobs::state(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const Job& job = at(id);
  const auto until = job.state == "running" ? Clock::now() : job.ended;
  return json_text({{"state", job.state},
                    {"progress", job.progress},
                    {"message", job.message},
                    {"run", job.run},
                    {"seconds", std::chrono::duration<double>(until - job.started).count()}});
}

void Jobs::cancel(const std::string& id) {
  const std::lock_guard lock(mutex_);
  at(id).thread.request_stop();
}

}  // namespace slideway
