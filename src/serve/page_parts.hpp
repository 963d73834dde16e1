#pragma once

#include <string_view>

/// The parts of the page, embedded at build time from src/serve/page.
namespace slideway::serve_page {

extern const std::string_view kBody, kStyle, kScript;

}  // namespace slideway::serve_page
