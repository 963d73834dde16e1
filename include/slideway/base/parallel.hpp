#pragma once

#include <cstddef>
#include <functional>

namespace slideway {

/// Calls work(0) ... work(count - 1) on as many threads as the machine has and limit_threads()
/// allows. Each call must write to a place of its own, so that the result is the same for any
/// number of threads. The exception of the lowest index that threw is thrown again when all have
/// ended.
void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work);

/// At most so many threads in this process from now on, for one whose siblings work on the other
/// processors.
void limit_threads(unsigned most);

}  // namespace slideway
