#include "slideway/batch/pool.hpp"
#include "slideway/batch/results.hpp"
#include "torture/drawn_json.hpp"

namespace slideway {
namespace {

constexpr const char* kManifest =
    "id,problem,machine,time\na,p.toml,M,2026-01-01\nb,p.toml,M,2026-01-02\nc,p.toml,M,2026-01-04\n"
    "d,p.toml,N,\n";

/// Results of four items, each line now and then changed, cut, or there twice.
std::string drawn_results(Draw& draw) {
  static const std::vector<std::string> kLines{sound_line("a"), sound_line("b"), sound_line("c"),
                                               sound_line("d")};
  std::string text;
  for (const std::string& line : kLines) {
    std::string drawn = draw.once_in(3) ? line : draw_json(draw, line) + "\n";
    if (draw.once_in(12)) drawn.resize(draw.below(std::min<std::size_t>(drawn.size(), 65536)));
    text += drawn;
    if (draw.once_in(8)) text += drawn;
  }
  return text;
}

}  // namespace
}  // namespace slideway

// Results of a batch through all that reads them; a text that begins with { is taken as it is.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  Draw draw({data, size});
  const bool is_text = size > 0 && data[0] == '{';
  const std::string text = is_text ? std::string(text_of(data, size)) : drawn_results(draw);
  const MemoryFile results(text), merged("");
  const Manifest manifest = parse_manifest(kManifest, "manifest.csv");
  ends_well([&] { static_cast<void>(verify_results(manifest, {}, results.path())); });
  ends_well([&] {
    const auto machines = pool_machines(manifest, results.path());
    require(pooled_text(machines, true).find("nan") == std::string::npos, "nan in the text");
    static_cast<void>(pooled_json(machines, true));
  });
  std::size_t whole = 0;
  ends_well([&] {
    const std::size_t torn = read_results(results.path(), [&](const ResultHead& head, auto) {
      require(!head.id.empty() && !head.status.empty(), "a head without id or status");
      ++whole;
    });
    require(torn + whole <= text.size(), "more lines than bytes");
  });
  return 0;
}
