#pragma once

#include <cstddef>
#include <functional>

namespace slideway {

/// Calls work(0) ... work(count - 1) on as many threads as the machine has and limit_threads()
/// allows. Each call must write to a place of its own, so that the result is the same for any
/// number of threads. The exception of the lowest index that threw is thrown again when all have
/// ended.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// How many parts of a size there are in a count; the last may be smaller.
constexpr std::size_t parts_of(std::size_t count, std::size_t size) {
  return (count + size - 1) / size;
}

/// Calls work(part, first, last) for every part of a size in 0 ... count - 1, `last` being behind
/// it; as parallel_for().
void parallel_parts(std::size_t count, std::size_t size,
                    const std::function<void(std::size_t, std::size_t, std::size_t)>& work);

/// At most so many threads in this process from now on, for one whose siblings work on the other
/// processors.
void limit_threads(unsigned most);

}  // namespace slideway
