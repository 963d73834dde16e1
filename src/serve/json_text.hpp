#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace slideway {

/// On one line; bytes that are no UTF-8 are replaced.
inline std::string json_text(const nlohmann::ordered_json& document) {
  return document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace slideway
