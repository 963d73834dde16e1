#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace slideway {

using Json = nlohmann::ordered_json;

template <typename T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

template <typename Range, typename Function>
Json array_of(const Range& range, Function&& to_json) {
  Json array = Json::array();
  for (const auto& item : range) array.push_back(to_json(item));
  return array;
}

/// The document over several lines; what is no UTF-8 in it, a file's name, is replaced.
std::string laid_out(const Json& document);

}  // namespace slideway
