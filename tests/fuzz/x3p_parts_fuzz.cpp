#include <array>

#include "format/registry.hpp"
#include "format/zip_archive.hpp"
#include "fuzz/sound.hpp"

// The archive guards its entries with CRCs, which no chance change gets past: the input is main.xml
// and, behind a zero byte, the points.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  const std::string_view bytes = text_of(data, size);
  const std::size_t main_size = std::min(bytes.find('\0'), bytes.size());
  const std::array<std::pair<std::string, std::string>, 2> files{
      {{"main.xml", std::string(bytes.substr(0, main_size))},
       {"bindata/data.bin", std::string(bytes.substr(std::min(main_size + 1, bytes.size())))}}};
  const std::string archive = zip_archive(files);
  for (const char* line : {"", "row:1", "diameter:30"})
    ends_well([&] {
      require_sound(x3p_format().read(archive, {.line = line, .ignore_checksum = true}));
    });
  return 0;
}
