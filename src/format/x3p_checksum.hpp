#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slideway {

/// MD5 of the bytes, 32 lower-case hexadecimal digits (RFC 1321); X3P has no other checksum.
std::string md5(std::string_view bytes);

/// Compares what X3P says of its parts with what they are.
class ChecksumGate {
 public:
  /// Whether a mismatch is a decision to tell of rather than an error.
  explicit ChecksumGate(bool ignore) : ignore_(ignore) {}

  /// @throws DataError if the digits the file gives (none: "") are not the MD5 of the bytes
  void check(std::string_view bytes, std::string_view digits, const std::string& part);

  [[nodiscard]] const std::vector<std::string>& decisions() const { return decisions_; }

 private:
  bool ignore_;
  std::vector<std::string> decisions_;
};

}  // namespace slideway
