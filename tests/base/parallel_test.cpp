#include "slideway/base/parallel.hpp"

#include <gmock/gmock.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace slideway {
namespace {

using testing::Each;
using testing::ThrowsMessage;

TEST(ParallelFor, DoesEveryIndexOnce) {
  for (const std::size_t count : {0U, 1U, 2U, 1000U}) {
    std::vector<int> done(count, 0);
    parallel_for(count, [&](std::size_t i) { ++done[i]; });
    EXPECT_THAT(done, Each(1));
  }
}

TEST(ParallelFor, ThrowsWhatTheFirstIndexThrewWhoeverWasFaster) {
  EXPECT_THAT(
      [] {
        parallel_for(100, [](std::size_t i) {
          if (i % 10 == 7) throw std::runtime_error(std::to_string(i));
        });
      },
      ThrowsMessage<std::runtime_error>("7"));
}

TEST(ParallelFor, MayRunWithinItself) {
  std::vector<std::vector<int>> done(20, std::vector<int>(20, 0));
  parallel_for(20, [&](std::size_t i) { parallel_for(20, [&](std::size_t k) { ++done[i][k]; }); });
  EXPECT_THAT(done, Each(Each(1)));
}

}  // namespace
}  // namespace slideway
