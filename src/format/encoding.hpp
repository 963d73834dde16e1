#pragma once

#include <string>
#include <string_view>

namespace slideway {

/// A text as UTF-8 or Latin-1 bytes without a byte order mark.
struct DecodedText {
  std::string_view given;  // the input, if it needed no conversion
  std::string converted;
  std::string encoding;  // "utf-8" "utf-16" "latin-1"; empty if not yet known
  [[nodiscard]] std::string_view bytes() const {
    return converted.empty() ? given : std::string_view(converted);
  }
};

/// Takes a byte order mark off and UTF-16, with or without one, into UTF-8.
/// @param asked  "utf-8" "utf-16" "latin-1", or empty
/// @throws DataError  half a character
DecodedText decoded(std::string_view bytes, std::string_view asked);

bool is_utf8(std::string_view text);
std::string utf8_from_latin1(std::string_view text);

}  // namespace slideway
