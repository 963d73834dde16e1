#include "slideway/batch/process_pool.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "slideway/base/parallel.hpp"
#include "slideway/base/sanitizer.hpp"
#include "slideway/base/text.hpp"
#include "slideway/batch/item.hpp"

namespace slideway {
namespace {

using Size = std::uint64_t;

[[noreturn]] void fail(const char* what, int error = errno) {
  throw std::runtime_error(std::string(what) + ": " + std::generic_category().message(error));
}

/// Sends the size and the text. False if the other end is closed.
bool send_text(int socket, const std::string& text) {
  const Size size = text.size();
  std::string bytes(sizeof size, '\0');
  std::memcpy(bytes.data(), &size, sizeof size);
  bytes += text;
  for (std::string_view rest = bytes; !rest.empty();) {
    const ssize_t count = ::send(socket, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (count < 0 && errno != EINTR) return false;
    if (count > 0) rest.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

std::optional<std::string> receive_bytes(int socket, Size size) {
  std::string bytes(size, '\0');
  for (Size got = 0; got < size;) {
    const ssize_t count = ::recv(socket, bytes.data() + got, size - got, 0);
    if (count == 0 || (count < 0 && errno != EINTR)) return std::nullopt;
    if (count > 0) got += static_cast<Size>(count);
  }
  return bytes;
}

std::optional<std::string> receive_text(int socket) {
  const std::optional<std::string> front = receive_bytes(socket, sizeof(Size));
  if (!front) return std::nullopt;
  Size size = 0;
  std::memcpy(&size, front->data(), sizeof size);
  return receive_bytes(socket, size);
}

void limit_memory(std::uint64_t bytes) {
  struct rlimit limit {};
  if (kHasShadow || bytes == 0 || ::getrlimit(RLIMIT_DATA, &limit) != 0) return;
  ::malloc_trim(0);  // the limit counts what the heap has kept
  limit.rlim_cur = std::min<rlim_t>(bytes, limit.rlim_max);
  ::setrlimit(RLIMIT_DATA, &limit);
}

/// Checked before any worker is started, so that one line says what is lacking.
void require_descriptors(std::size_t workers) {
  constexpr rlim_t kOthers = 32;  // files that the program and its libraries keep open
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  const rlim_t needed = workers + kOthers;
  if (limit.rlim_cur >= needed) return;
  limit.rlim_cur = std::min(needed, limit.rlim_max);
  if (limit.rlim_cur == needed && ::setrlimit(RLIMIT_NOFILE, &limit) == 0) return;
  throw std::runtime_error(std::to_string(workers) + " worker processes need " +
                           std::to_string(needed) + " open files; the system allows " +
                           std::to_string(limit.rlim_max) + " (ulimit -n)");
}

std::string described(int status) {
  if (!WIFSIGNALED(status)) return "ended with exit code " + std::to_string(WEXITSTATUS(status));
  return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
         ::sigdescr_np(WTERMSIG(status)) + ")";
}

}  // namespace

ProcessPool::ProcessPool(std::size_t count, Work work, const WorkerLimits& limits)
    : work_(std::move(work)), limits_(limits), workers_(count) {
  require_descriptors(count);
  try {
    for (Worker& worker : workers_) start(worker);
  } catch (...) {
    end_all();
    throw;
  }
}

ProcessPool::~ProcessPool() { end_all(); }

void ProcessPool::end_all() noexcept {
  for (Worker& worker : workers_) end(worker);
}

void ProcessPool::start(Worker& worker) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("socketpair");
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    for (const int socket : ends) ::close(socket);
    fail("fork", error);
  }
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // the parent ended before prctl()
    // The worker inherits no socket of another worker and no results file.
    constexpr int kSocket = 3;
    ::dup2(ends[1], kSocket);
    ::close_range(kSocket + 1, ~0U, 0);
    serve(kSocket);
  }
  ::close(ends[1]);
  worker = {.process = child, .socket = ends[0]};
}

void ProcessPool::serve(int socket) const {
  limit_memory(limits_.memory_bytes);
  limit_threads(1);
  while (const std::optional<std::string> task = receive_text(socket))
    if (!send_text(socket, work_(*task))) break;
  ::_exit(0);
}

int ProcessPool::end(Worker& worker) noexcept {
  if (worker.process < 0) return 0;
  ::close(std::exchange(worker.socket, -1));
  ::kill(worker.process, SIGKILL);  // no effect on one that has ended
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  worker.process = -1;
  return status;
}

bool ProcessPool::has_idle() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.is_busy; });
}

std::size_t ProcessPool::pending() const {
  return static_cast<std::size_t>(
      std::count_if(workers_.begin(), workers_.end(), [](const Worker& w) { return w.is_busy; }));
}

void ProcessPool::submit(std::string task) {
  Worker& worker =
      *std::find_if(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.is_busy; });
  if (!send_text(worker.socket, task)) {  // ended from outside while idle
    end(worker);
    start(worker);
    send_text(worker.socket, task);
  }
  worker.is_busy = true;
  worker.task = std::move(task);
  if (limits_.time) worker.deadline = Clock::now() + *limits_.time;
}

int ProcessPool::poll_timeout(std::chrono::milliseconds timeout) const {
  Clock::time_point until = Clock::now() + timeout;
  for (const Worker& worker : workers_)
    if (worker.is_busy) until = std::min(until, worker.deadline);
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

bool ProcessPool::receive(Worker& worker) {
  std::array<char, 65536> chunk;
  const ssize_t count = ::recv(worker.socket, chunk.data(), chunk.size(), MSG_DONTWAIT);
  if (count > 0) worker.received.append(chunk.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && (errno == EINTR || errno == EAGAIN));
}

std::vector<TaskResult> ProcessPool::collect(std::chrono::milliseconds timeout) {
  std::vector<pollfd> sockets;
  for (const Worker& worker : workers_)
    sockets.push_back({worker.socket, static_cast<short>(worker.is_busy ? POLLIN : 0), 0});
  ::poll(sockets.data(), sockets.size(), poll_timeout(timeout));

  std::vector<TaskResult> results;
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    Worker& worker = workers_[i];
    if (!worker.is_busy) continue;
    const bool is_running = sockets[i].revents == 0 || receive(worker);
    Size size = 0;
    if (worker.received.size() >= sizeof size)
      std::memcpy(&size, worker.received.data(), sizeof size);
    if (size > 0 && worker.received.size() == sizeof size + size) {
      results.push_back({std::move(worker.task), worker.received.substr(sizeof size), "", ""});
      worker = {.process = worker.process, .socket = worker.socket};
    } else if (!is_running) {
      const std::string how = described(end(worker));
      results.push_back({std::move(worker.task), std::nullopt, status::kCrashed, how});
      start(worker);
    } else if (Clock::now() >= worker.deadline) {
      end(worker);
      const double seconds = std::chrono::duration<double>(*limits_.time).count();
      results.push_back({std::move(worker.task), std::nullopt, status::kTimeout,
                         "took longer than " + shortest(seconds) + " s"});
      start(worker);
    }
  }
  return results;
}

}  // namespace slideway
