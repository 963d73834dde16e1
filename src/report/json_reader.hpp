#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "document_node.hpp"
#include "list_lengths.hpp"
#include "slideway/base/record.hpp"

/// Reads a record back that JsonWriter wrote. Keys it does not know are passed over; a key that is
/// missing, or of the wrong type, is a DataError with its place.
namespace slideway {

template <Recorded T>
void read(const Node& node, T& object);

inline void read(const Node& node, bool& out) { out = node.truth(); }
inline void read(const Node& node, int& out) { out = node.small_integer(); }
inline void read(const Node& node, std::size_t& out) { out = node.count(); }
inline void read(const Node& node, std::string& out) { out = node.text(); }
inline void read(const Node& node, double& out) {
  const bool is_left_out = node.is_null() && !node.is_missing();  // it was not finite
  out = is_left_out ? std::numeric_limits<double>::quiet_NaN() : node.number();
}
inline void read(const Node& node, std::vector<std::pair<std::string, double>>& out) {
  for (const std::string& key : node.keys())
    read(node[key], out.emplace_back(printable(key, std::string::npos), 0.0).second);
}
inline void read(const Node& node, std::map<std::string, std::string>& out) {
  for (const std::string& key : node.keys()) out[key] = node[key].text();
}

template <Named Enum>
void read(const Node& node, Enum& out) {
  const std::optional<Enum> found = from_text<Enum>(node.verbatim());
  if (!found) {
    std::vector<std::string> known;
    for (const std::string_view text : kTexts<Enum>) known.push_back('"' + std::string(text) + '"');
    node.fail(joined(known, " or "));
  }
  out = *found;
}

template <typename T>
void read(const Node& node, std::optional<T>& out) {
  if (!node.is_null()) read(node, out.emplace());
}

template <typename T>
void read(const Node& node, std::vector<T>& out) {
  out = node.list([](const Node& each) {
    T value{};
    read(each, value);
    return value;
  });
}

inline void read(const Node& node, std::tuple<std::string, std::string, double>& out) {
  const std::vector<Node> parts = node.entries();
  if (parts.size() != 3) node.fail("two names and a coefficient");
  read(parts[0], std::get<0>(out));
  read(parts[1], std::get<1>(out));
  read(parts[2], std::get<2>(out));
}

template <Recorded T>
void read(const Node& node, T& object) {
  for_each_field<T>([&](const auto& field) {
    const Node value = node[std::string(field.key)];
    auto& member = std::invoke(field.access, object);
    if constexpr (std::is_same_v<decltype(member), std::string&>) {
      if (field.digits == kJsonText) {
        member = value.json_text();
        return;
      }
    }
    read(value, member);
  });
  check_lengths(node, object);
}

}  // namespace slideway
