#include "format/registry.hpp"
#include "fuzz/sound.hpp"

#define JOINED(a, b) a##b
#define FORMAT_OF(name) JOINED(name, _format)()

namespace slideway {
namespace {

const TraceRequest kRequests[] = {
    {},
    {.ignore_checksum = true},
    {.line = "row:1", .ignore_checksum = true},
    {.line = "diameter:30", .ignore_checksum = true},
};

/// What was read and can be written is read back.
void require_written(const Format& format, const Trace& trace) {
  std::string bytes;
  if (!format.is_writable() || !ends_well([&] { bytes = format.write(trace); })) return;
  Trace back;
  require(ends_well([&] { back = format.read(bytes, {}); }), "what was written is refused");
  require(back.values.size() == trace.values.size(), "points are lost");
}

}  // namespace
}  // namespace slideway

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace slideway;
  const Format& format = FORMAT_OF(SLIDEWAY_FUZZED);
  for (const TraceRequest& request : kRequests)
    ends_well([&] {
      const Trace trace = format.read(text_of(data, size), request);
      require_sound(trace);
      require_written(format, trace);
    });
  return 0;
}
