#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "slideway/identify/result.hpp"
#include "slideway/trace/details.hpp"
#include "slideway/trace/trace.hpp"

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

Json parameter_json(const FittedParameter& parameter);

/// The `trace` part of the report.
Json trace_json(const TraceResult& trace);

/// All of the details but the curves, put into the report under keys of their own.
void add_details(const Details& details, Json& report);

/// The `curves` part; numbers with as many digits as a picture needs.
Json curves_json(const Details& details);

}  // namespace slideway
