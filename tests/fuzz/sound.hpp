#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/format/format.hpp"

/// What must hold for whatever comes out of whatever bytes; a breach ends the process, which
/// libFuzzer reports with the input.
namespace slideway {

[[noreturn]] inline void breach(const std::string& what) {
  std::fprintf(stderr, "breach: %s\n", what.c_str());
  std::abort();
}

inline void require(bool holds, const std::string& what) {
  if (!holds) breach(what);
}

/// One line of valid UTF-8 without control characters.
inline void require_line(const std::string& text) {
  require(!text.empty() && printable(text, text.size()) == text, "no printable line: " + text);
}

inline void require_sound(const Trace& trace) {
  require(trace.positions.size() == trace.values.size(), "positions and values differ in number");
  for (const double position : trace.positions) require(std::isfinite(position), "a position");
  for (const double value : trace.values) require(!std::isinf(value), "an infinite value");
  for (const std::string& decision : trace.decisions) require_line(decision);
}

/// Whether it ends without an error; one of the two the library throws is the other way to end.
template <typename Function>
bool ends_well(const Function& function) {
  try {
    function();
    return true;
  } catch (const DataError& error) {
    require_line(error.what());
  } catch (const UsageError& error) {
    require_line(error.what());
  }
  return false;
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The bytes as a file that lies in memory.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view bytes) : number_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    require(number_ >= 0 &&
                ::write(number_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()),
            "no memory file");
  }
  ~MemoryFile() { ::close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::filesystem::path path() const {
    return "/proc/self/fd/" + std::to_string(number_);
  }

 private:
  int number_;
};

}  // namespace slideway
