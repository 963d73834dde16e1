#include <glog/logging.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"
#include "command_list.hpp"
#include "output.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/sanitizer.hpp"

namespace slideway {

namespace {

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    std::cerr << first_steps();
    return kBadUsage;
  }
  if (arguments[0] == "--help" || arguments[0] == "-h") {
    print(program_help());
    return kDone;
  }
  if (arguments[0] == "--version") {
    print("slideway " SLIDEWAY_VERSION "\n");
    return kDone;
  }
  const std::unique_ptr<Command> command = make_command(arguments[0]);
  if (!command->setup({arguments.begin() + 1, arguments.end()})) return kDone;
  return command->run();
}

// Page faults cost more than the arithmetic on the pages: freed memory stays in the heap for the
// next matrix, and the heap uses huge pages where the system has them.
void prepare_memory() {
  if (kHasShadow) return;
  constexpr std::size_t kRoom = 1 << 30, kHugePage = 1 << 21;
  mallopt(M_MMAP_THRESHOLD, kRoom);
  mallopt(M_TRIM_THRESHOLD, kRoom);
  void* const room = std::malloc(kRoom - kHugePage);  // address space only
  if (room == nullptr) return;
  void* first = room;
  std::size_t left = kRoom - kHugePage;
  if (std::align(kHugePage, kRoom - 2 * kHugePage, first, left) != nullptr)
    ::madvise(first, kRoom - 2 * kHugePage, MADV_HUGEPAGE);
  std::free(room);
}

[[noreturn]] void end_with(std::string_view line, int code) {
  static_cast<void>(!::write(STDERR_FILENO, line.data(), line.size()));
  ::_exit(code);
}

// A mapped file that is cut short while it is read.
void end_at_missing_bytes(int /*signal*/) {
  end_with("slideway: a file was cut short while it was read\n", kBadData);
}

// Memory that ends where nothing may be thrown: a destructor of a library that allocates.
[[noreturn]] void end_without_memory() {
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::bad_alloc&) {
    end_with("slideway: out of memory\n", kFailed);
  } catch (...) {
  }
  std::abort();
}

int failed(int code, std::string_view message) {
  say(message);
  return code;
}

}  // namespace
}  // namespace slideway

int main(int argc, char** argv) {
  using namespace slideway;
  prepare_memory();
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres logs by glog to stderr
  // Writing to a closed pipe, or beyond the file size limit, is then a failed write.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGBUS, end_at_missing_bytes);
  std::set_terminate(end_without_memory);
  try {
    return run({argv + 1, argv + argc});
  } catch (const UsageError& error) {
    return failed(kBadUsage, error.what());
  } catch (const DataError& error) {
    return failed(kBadData, error.what());
  } catch (const std::bad_alloc&) {
    return failed(kFailed, "out of memory");
  } catch (const std::exception& error) {
    return failed(kFailed, error.what());
  } catch (...) {
    return failed(kFailed, "unknown error");
  }
}
