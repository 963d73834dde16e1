#include <algorithm>

#include "fuzz/sound.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  const std::string_view bytes = text_of(data, size);
  const auto all = formats();
  const auto recognise = std::count_if(
      all.begin(), all.end(), [&](const Format* format) { return format->recognises(bytes); });
  require(recognise <= 1, "several formats recognise the file");
  const MemoryFile file(bytes);
  ends_well([&] {
    const TraceFile read = read_trace(file.path(), {.line = "row:1", .ignore_checksum = true});
    require(read.format == recognised_format(bytes).name(), "read as another format");
    require_sound(read.trace);
  });
  return 0;
}
