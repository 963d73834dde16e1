#include "page.hpp"

#include <array>
#include <cstdint>
#include <string_view>

#include "page_parts.hpp"
#include "slideway/base/file.hpp"
#include "slideway/report/chart_library.hpp"

namespace slideway {
namespace {

/// SHA-256 in Base64 (RFC 4648), as a policy names a script.
std::string hash_source(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::size_t kBits = 6, kHexBits = 4;
  std::string out;
  std::uint32_t bits = 0;
  std::size_t count = 0;
  for (const char digit : sha256(text)) {
    bits = bits << kHexBits |
           static_cast<std::uint32_t>(digit <= '9' ? digit - '0' : digit - 'a' + 10);
    count += kHexBits;
    if (count < kBits) continue;
    count -= kBits;
    out += kDigits[bits >> count & 63U];
  }
  out += kDigits[bits << (kBits - count) & 63U];
  return "'sha256-" + out + "='";
}

std::string tagged(const char* tag, std::string_view text) {
  return "<" + std::string(tag) + ">" + std::string(text) + "</" + tag + ">\n";
}

}  // namespace

HttpReply start_page() {
  using namespace serve_page;
  const std::array<std::string_view, 2> styles{page::kChartStyle, kStyle};
  const std::array<std::string_view, 2> scripts{page::kChartScript, kScript};
  std::string policy =
      "default-src 'none'; connect-src 'self'; frame-src 'self'; base-uri 'none'; "
      "form-action 'none'; frame-ancestors 'none'; script-src";
  std::string head, end;
  for (const std::string_view script : scripts) {
    policy += " " + hash_source(script);
    end += tagged("script", script);
  }
  policy += "; style-src";
  for (const std::string_view style : styles) {
    policy += " " + hash_source(style);
    head += tagged("style", style);
  }
  return {.type = "text/html; charset=utf-8",
          .body =
              "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
              "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
              "<meta name=\"color-scheme\" content=\"light dark\">\n<link rel=\"icon\" "
              "href=\"data:,\">\n<title>slideway</title>\n" +
              head + "</head>\n" + std::string(kBody) + end + "</html>\n",
          .headers = {{"Content-Security-Policy", policy + "; img-src data:"}}};
}

}  // namespace slideway
