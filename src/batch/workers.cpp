#include "slideway/batch/workers.hpp"

#include <fcntl.h>
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

[[noreturn]] void fail(const char* what) {
  throw std::runtime_error(std::string(what) + ": " + std::generic_category().message(errno));
}

/// A text with its size in front. False if nobody is there to read it.
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
  limit.rlim_cur = std::min<rlim_t>(bytes, limit.rlim_max);
  ::setrlimit(RLIMIT_DATA, &limit);
}

std::string described(int status) {
  if (!WIFSIGNALED(status)) return "ended with exit code " + std::to_string(WEXITSTATUS(status));
  return "ended by signal " + std::to_string(WTERMSIG(status)) + " (" +
         ::sigdescr_np(WTERMSIG(status)) + ")";
}

}  // namespace

Workers::Workers(std::size_t count, Work work, const WorkerLimits& limits)
    : work_(std::move(work)), limits_(limits), workers_(count) {
  for (Worker& worker : workers_) start(worker);
}

Workers::~Workers() {
  for (Worker& worker : workers_) end(worker);
}

void Workers::start(Worker& worker) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail("socketpair");
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) fail("fork");
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(1);  // it was gone before
    // Of the other workers' sockets and the results nothing is left open here.
    constexpr int kSocket = 3;
    ::dup2(ends[1], kSocket);
    ::close_range(kSocket + 1, ~0U, 0);
    work_at(kSocket);
  }
  ::close(ends[1]);
  worker = {.process = child, .socket = ends[0]};
}

void Workers::work_at(int socket) const {
  limit_memory(limits_.memory_bytes);
  limit_threads(1);
  while (const std::optional<std::string> task = receive_text(socket))
    if (!send_text(socket, work_(*task))) break;
  ::_exit(0);
}

std::string Workers::end(Worker& worker) {
  ::close(std::exchange(worker.socket, -1));
  ::kill(worker.process, SIGKILL);  // nothing to one that has ended
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  return described(status);
}

bool Workers::has_idle() const {
  return std::any_of(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.is_busy; });
}

std::size_t Workers::busy() const {
  return static_cast<std::size_t>(
      std::count_if(workers_.begin(), workers_.end(), [](const Worker& w) { return w.is_busy; }));
}

void Workers::give(std::string task) {
  Worker& worker =
      *std::find_if(workers_.begin(), workers_.end(), [](const Worker& w) { return !w.is_busy; });
  if (!send_text(worker.socket, task)) {  // somebody has ended it meanwhile
    end(worker);
    start(worker);
    send_text(worker.socket, task);
  }
  worker.is_busy = true;
  worker.task = std::move(task);
  if (limits_.time) worker.deadline = Clock::now() + *limits_.time;
}

int Workers::patience(std::chrono::milliseconds longest) const {
  Clock::time_point until = Clock::now() + longest;
  for (const Worker& worker : workers_)
    if (worker.is_busy) until = std::min(until, worker.deadline);
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

bool Workers::receive(Worker& worker) {
  std::array<char, 65536> chunk;
  const ssize_t count = ::recv(worker.socket, chunk.data(), chunk.size(), MSG_DONTWAIT);
  if (count > 0) worker.received.append(chunk.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && (errno == EINTR || errno == EAGAIN));
}

std::vector<Answer> Workers::wait(std::chrono::milliseconds longest) {
  std::vector<pollfd> sockets;
  for (const Worker& worker : workers_)
    sockets.push_back({worker.socket, static_cast<short>(worker.is_busy ? POLLIN : 0), 0});
  ::poll(sockets.data(), sockets.size(), patience(longest));

  std::vector<Answer> answers;
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    Worker& worker = workers_[i];
    if (!worker.is_busy) continue;
    const bool is_there = sockets[i].revents == 0 || receive(worker);
    Size size = 0;
    if (worker.received.size() >= sizeof size)
      std::memcpy(&size, worker.received.data(), sizeof size);
    if (size > 0 && worker.received.size() == sizeof size + size) {
      answers.push_back({std::move(worker.task), worker.received.substr(sizeof size), "", ""});
      worker = {.process = worker.process, .socket = worker.socket};
    } else if (!is_there) {
      const std::string how = end(worker);
      answers.push_back({std::move(worker.task), std::nullopt, status::kCrashed, how});
      start(worker);
    } else if (Clock::now() >= worker.deadline) {
      end(worker);
      const double seconds = std::chrono::duration<double>(*limits_.time).count();
      answers.push_back({std::move(worker.task), std::nullopt, status::kTimeout,
                         "took longer than " + shortest(seconds) + " s"});
      start(worker);
    }
  }
  return answers;
}

}  // namespace slideway
