#pragma once

#include <cstddef>
#include <functional>

namespace slideway {

/// Calls work(0) ... work(count - 1) on as many threads as the machine has and limit_threads()
/// allows. Each call must write to its own memory, so that the result is the same for any number of
/// threads. After all calls, the exception of the lowest index that threw is rethrown.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// Number of parts of a size in a count; the last may be smaller.
constexpr std::size_t parts_of(std::size_t count, std::size_t size) {
  return (count + size - 1) / size;
}

/// Calls work(part, first, last) for the parts first ... last - 1 of 0 ... count - 1, as
/// parallel_for().
void parallel_parts(std::size_t count, std::size_t size,
                    const std::function<void(std::size_t, std::size_t, std::size_t)>& work);

/// Limits the threads of this process from now on, for a worker process beside others.
void limit_threads(unsigned most);

}  // namespace slideway
