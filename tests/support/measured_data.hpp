#pragma once

#include <cstdlib>
#include <filesystem>

namespace slideway {

/// Where the really measured data are, if anywhere.
inline std::filesystem::path measured_data() {
  const char* given = std::getenv("SLIDEWAY_DATA");
  return given != nullptr ? std::filesystem::path(given)
                          : std::filesystem::path(SLIDEWAY_SOURCE_DIR) / "../shared/data";
}

}  // namespace slideway
