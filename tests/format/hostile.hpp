#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "format/registry.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/file.hpp"
#include "support/measured_data.hpp"

namespace slideway {

/// A measured file under SLIDEWAY_DATA, or nothing if the data are not there.
inline std::string sample(const std::string& name) {
  const std::filesystem::path file = measured_data() / name;
  return exists(file) ? std::string(FileBytes(file).text()) : std::string();
}

/// The message with which a file is refused, checked to be one line; "" if it is read.
inline std::string refusal(const Format& format, const std::string& bytes,
                           const TraceRequest& request = {}) {
  try {
    (void)format.read(bytes, request);
  } catch (const DataError& error) {
    const std::string message = error.what();
    EXPECT_FALSE(message.empty());
    for (const char c : message) EXPECT_GE(static_cast<unsigned char>(c), 0x20) << message;
    return message;
  }
  return "";
}

inline void expect_every_truncation_refused(const Format& format, const std::string& bytes,
                                            const TraceRequest& request = {}) {
  EXPECT_EQ(refusal(format, bytes, request), "");
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(refusal(format, bytes.substr(0, size), request), "") << size << " bytes";
}

inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), by);
}

}  // namespace slideway
