#include "fuzz/sound.hpp"
#include "slideway/identify/problem.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  const MemoryFile file(text_of(data, size));
  ends_well([&] {
    const Problem problem = read_problem(file.path(), std::filesystem::path("/proc/self/fdinfo"));
    require(!problem.profiles.empty() && !problem.effects.empty(), "an empty problem");
  });
  return 0;
}
