#include "worker.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "slideway/base/sanitizer.hpp"

namespace slideway {
namespace {

constexpr std::size_t kMostText = std::size_t{8} << 20;
constexpr std::chrono::milliseconds kLook{50}, kLookForEnd{2};  // for a stop

[[noreturn]] void fail_to_start(const char* what) {
  throw std::runtime_error(std::string(what) + ": " + std::generic_category().message(errno));
}

/// A file descriptor that is closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }

 private:
  int number_;
};

struct Channel {
  Descriptor read, write;
};

Channel pipe_channel() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail_to_start("pipe");
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// A terminal, on which a command shows its progress; a pipe where the system has no more of them.
Channel terminal_channel() {
  Descriptor master(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC));
  std::array<char, 128> name{};
  if (master.number() < 0 || ::grantpt(master.number()) != 0 || ::unlockpt(master.number()) != 0 ||
      ::ptsname_r(master.number(), name.data(), name.size()) != 0)
    return pipe_channel();
  Descriptor slave(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (slave.number() < 0) return pipe_channel();
  return {std::move(master), std::move(slave)};
}

void set_limit(__rlimit_resource which, rlim_t value) {
  const struct rlimit limit { value, value };
  ::setrlimit(which, &limit);
}

void set_limits(const WorkerTask& task) {
  constexpr rlim_t kMostFile = rlim_t{1} << 30, kProcessors = 64;
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_FSIZE, kMostFile);
  set_limit(RLIMIT_CPU, static_cast<rlim_t>(task.time.count()) * kProcessors);
  if (!kHasShadow && task.memory_bytes > 0) set_limit(RLIMIT_DATA, task.memory_bytes);
}

/// In the new process, where only what is safe after fork() may be called.
[[noreturn]] void become(const WorkerTask& task, char* const* arguments, int output, pid_t parent) {
  static char term[] = "TERM=xterm", colour[] = "NO_COLOR=1";
  static char* const kEnvironment[] = {term, colour, nullptr};
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(nowhere, STDIN_FILENO);
  ::dup2(task.shows_progress ? nowhere : output, STDOUT_FILENO);
  ::dup2(task.shows_progress ? output : nowhere, STDERR_FILENO);
  ::close_range(STDERR_FILENO + 1, ~0U, 0);
  set_limits(task);
  if (::chdir(task.folder.c_str()) == 0) ::execve(task.program.c_str(), arguments, kEnvironment);
  ::_exit(127);
}

pid_t start(const WorkerTask& task, int output) {
  std::vector<std::string> words{"slideway"};
  words.insert(words.end(), task.arguments.begin(), task.arguments.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) fail_to_start("fork");
  if (child == 0) become(task, arguments.data(), output, parent);
  ::setpgid(child, child);
  return child;
}

std::string described_end(int status) {
  if (WIFSIGNALED(status))
    return std::string("ended by signal: ") + ::sigdescr_np(WTERMSIG(status));
  return WEXITSTATUS(status) == 127 ? "could not be started" : "";
}

/// Reads what is there. @return false: the other end is closed
bool read_some(int file, std::string& text) {
  std::array<char, 65536> chunk;
  const ssize_t count = ::read(file, chunk.data(), chunk.size());
  if (count <= 0) return count < 0 && errno == EINTR;
  text.append(chunk.data(), static_cast<std::size_t>(count));
  if (text.size() > kMostText) text.erase(0, text.size() - kMostText);
  return true;
}

}  // namespace

WorkerEnd run_worker(const WorkerTask& task, const std::stop_token& stop,
                     const std::function<void(std::string_view)>& told) {
  using Clock = std::chrono::steady_clock;
  Channel channel = task.shows_progress ? terminal_channel() : pipe_channel();
  const auto deadline = Clock::now() + task.time;
  const pid_t child = start(task, channel.write.number());
  channel.write = Descriptor(-1);

  WorkerEnd end;
  int status = 0;
  for (bool is_open = true, is_running = true; is_running && end.cause.empty();) {
    pollfd wait{is_open ? channel.read.number() : -1, POLLIN, 0};
    ::poll(&wait, 1, static_cast<int>((is_open ? kLook : kLookForEnd).count()));
    if (stop.stop_requested())
      end.cause = "cancelled";
    else if (Clock::now() >= deadline)
      end.cause = "took longer than " + std::to_string(task.time.count()) + " s";
    else if (!is_open)
      is_running = ::waitpid(child, &status, WNOHANG) == 0;
    else if (wait.revents != 0 && (is_open = read_some(channel.read.number(), end.text)) && told)
      told(end.text);
  }
  if (!end.cause.empty()) {
    ::kill(-child, SIGKILL);
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
  }
  if (end.cause.empty()) end.cause = described_end(status);
  if (end.cause.empty()) end.exit_code = WEXITSTATUS(status);
  return end;
}

}  // namespace slideway
