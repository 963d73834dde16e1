#include "slideway/base/parallel.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <limits>
#include <thread>
#include <vector>

namespace slideway {
namespace {

std::atomic<unsigned> most_threads{std::numeric_limits<unsigned>::max()};

}  // namespace

void limit_threads(unsigned most) { most_threads = std::max(1U, most); }

void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(count);
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  const std::size_t threads = std::min<std::size_t>(
      count, std::clamp(std::thread::hardware_concurrency(), 1U, most_threads.load()));
  {
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < threads; ++t) others.emplace_back(run);
    run();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

void parallel_parts(std::size_t count, std::size_t size,
                    const std::function<void(std::size_t, std::size_t, std::size_t)>& work) {
  parallel_for(parts_of(count, size), [&](std::size_t part) {
    work(part, part * size, std::min(count, (part + 1) * size));
  });
}

}  // namespace slideway
