#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "json_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {

/// A value of a document with its place in it, read as what it is expected to be.
/// Every function throws DataError: "result.json: fit.parameters[0].unit: is a number; accepted:
/// a text".
class Node {
 public:
  Node(const Json& json, std::string file, std::string place)
      : json_(&json), file_(std::move(file)), place_(std::move(place)) {}

  [[nodiscard]] bool is_null() const { return json_->is_null(); }

  /// The value of a key; null where the key is missing.
  [[nodiscard]] Node operator[](const std::string& key) const {
    static const Json kNull;
    if (!json_->is_object()) fail("an object");
    const auto found = json_->find(key);
    return {found == json_->end() ? kNull : *found, file_,
            place_.empty() ? key : place_ + "." + key};
  }

  [[nodiscard]] double number() const {
    if (!json_->is_number()) fail("a number");
    return json_->get<double>();
  }
  [[nodiscard]] std::optional<double> number_or_null() const {
    if (is_null()) return std::nullopt;
    return number();
  }
  [[nodiscard]] std::size_t count() const {
    if (!json_->is_number_unsigned()) fail("a whole number, 0 or larger");
    return json_->get<std::size_t>();
  }
  [[nodiscard]] int small_integer() const {
    constexpr int kLargest = 1'000'000;
    if (!json_->is_number_integer() || number() < -kLargest || number() > kLargest)
      fail("a whole number within ±1000000");
    return json_->get<int>();
  }
  [[nodiscard]] bool truth() const {
    if (!json_->is_boolean()) fail("true or false");
    return json_->get<bool>();
  }
  /// Without what a terminal would obey.
  [[nodiscard]] std::string text() const {
    if (!json_->is_string()) fail("a text");
    return printable(json_->get_ref<const std::string&>(), std::string::npos);
  }
  [[nodiscard]] std::optional<std::string> text_or_null() const {
    if (is_null()) return std::nullopt;
    return text();
  }

  /// What `read` makes of each entry of a list.
  template <typename Read>
  [[nodiscard]] auto list(Read&& read) const {
    if (!json_->is_array()) fail("a list");
    std::vector<decltype(read(*this))> out;
    out.reserve(json_->size());
    for (std::size_t i = 0; i < json_->size(); ++i)
      out.push_back(read(Node((*json_)[i], file_, place_ + "[" + std::to_string(i) + "]")));
    return out;
  }
  [[nodiscard]] std::vector<std::string> texts() const {
    return list([](const Node& each) { return each.text(); });
  }
  [[nodiscard]] std::vector<double> numbers() const {
    return list([](const Node& each) { return each.number(); });
  }
  /// An object of numbers, in its order.
  [[nodiscard]] std::vector<std::pair<std::string, double>> named_numbers() const {
    if (!json_->is_object()) fail("an object of numbers");
    std::vector<std::pair<std::string, double>> out;
    for (const auto& [key, value] : json_->items())
      out.emplace_back(printable(key, std::string::npos),
                       Node(value, file_, place_ + "." + key).number());
    return out;
  }

  [[noreturn]] void fail(const std::string& accepted) const {
    const std::string what = is_null() ? "is missing" : std::string("is ") + json_->type_name();
    throw DataError(file_ + ": " + printable(place_, 80) + ": " + what + "; accepted: " + accepted);
  }

 private:
  const Json* json_;
  std::string file_, place_;
};

FittedParameter fitted_parameter(const Node& node);

/// The `trace` part of a report, with `before` and `after`.
TraceResult trace_result(const Node& report);

}  // namespace slideway
