#include "encoding.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "slideway/base/error.hpp"

namespace slideway {
namespace {

void append_utf8(std::string& text, std::uint32_t code) {
  const auto byte = [&](std::uint32_t value) { text += static_cast<char>(value); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xc0U | code >> 6U);
  } else {
    if (code < 0x10000) {
      byte(0xe0U | code >> 12U);
    } else {
      byte(0xf0U | code >> 18U);
      byte(0x80U | (code >> 12U & 0x3fU));
    }
    byte(0x80U | (code >> 6U & 0x3fU));
  }
  byte(0x80U | (code & 0x3fU));
}

std::string utf8_from_utf16(std::string_view bytes, bool big_endian) {
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(big_endian ? first << 8U | second : second << 8U | first);
  };
  const auto refuse = [](std::size_t at) {
    throw DataError("byte " + std::to_string(at + 1) + ": half a character of UTF-16");
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  std::size_t at = 0;
  for (; at + 1 < bytes.size(); at += 2) {
    std::uint32_t code = unit(at);
    if (code >= 0xdc00 && code <= 0xdfff) refuse(at);
    if (code >= 0xd800 && code <= 0xdbff) {
      const std::uint32_t low = at + 3 < bytes.size() ? unit(at + 2) : 0;
      if (low < 0xdc00 || low > 0xdfff) refuse(at);
      code = 0x10000 + ((code - 0xd800) << 10U) + (low - 0xdc00);
      at += 2;
    }
    append_utf8(text, code);
  }
  if (at < bytes.size()) refuse(at);
  return text;
}

// Whether every second byte of the start is zero, from `first` on, and none of the others.
bool is_utf16_of_ascii(std::string_view bytes, std::size_t first) {
  const std::size_t count = std::min<std::size_t>(bytes.size() / 2 * 2, 32);
  for (std::size_t i = 0; i < count; ++i)
    if ((bytes[i] == '\0') != (i % 2 == first)) return false;
  return count >= 4;
}

}  // namespace

DecodedText decoded(std::string_view bytes, std::string_view asked) {
  const bool may_be_utf16 = asked.empty() || asked == "utf-16";
  const bool little = bytes.starts_with("\xff\xfe"), big = bytes.starts_with("\xfe\xff");
  const bool ascii_big = is_utf16_of_ascii(bytes, 0);
  if (asked == "utf-16" ||
      (may_be_utf16 && (little || big || ascii_big || is_utf16_of_ascii(bytes, 1))))
    return {{}, utf8_from_utf16(bytes.substr(little || big ? 2 : 0), big || ascii_big), "utf-16"};
  const bool marked = asked != "latin-1" && bytes.starts_with("\xef\xbb\xbf");
  return {bytes.substr(marked ? 3 : 0), {}, marked ? "utf-8" : std::string(asked)};
}

bool is_utf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const std::size_t size = lead < 0x80 ? 1 : lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    if ((lead >= 0x80 && lead < 0xc2) || lead > 0xf4 || text.size() - at < size) return false;
    for (std::size_t i = 1; i < size; ++i)
      if ((static_cast<unsigned char>(text[at + i]) & 0xc0U) != 0x80U) return false;
    at += size;
  }
  return true;
}

std::string utf8_from_latin1(std::string_view text) {
  std::string out;
  for (const char c : text) append_utf8(out, static_cast<unsigned char>(c));
  return out;
}

}  // namespace slideway
