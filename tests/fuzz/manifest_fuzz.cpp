#include "fuzz/sound.hpp"
#include "slideway/batch/pool.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  constexpr const char* kProblem =
      "[machine]\nlever = \"paper\"\n[[profile]]\nname = \"face\"\nfile = \"face.csv\"\n"
      "position_unit = \"mm\"\nvalue_unit = \"um\"\n[[effect]]\nname = \"squareness\"\n";
  static const MemoryFile problem{kProblem};
  ends_well([&] {
    const Manifest manifest = parse_manifest(text_of(data, size), "manifest.csv");
    require(!manifest.items.empty(), "an empty manifest");
    for (const ManifestItem& item : manifest.items) {
      require_line(item.id);
      require(Shard{1, 2}.holds(item.id) != Shard{2, 2}.holds(item.id), "no shard, or two");
      ends_well([&] { read_problem(problem.path(), std::nullopt, item.overrides); });
    }
    static_cast<void>(read_times(manifest));
  });
  return 0;
}
