#pragma once

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "json_parts.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/trace/analysis.hpp"

namespace slideway {

/// A value of a document with its place in it, read as what it is expected to be. Every function
/// throws DataError: "fit.parameters[0].unit: is number; accepted: a text".
class Node {
 public:
  explicit Node(const Json& json, std::string place = "")
      : json_(&json), place_(std::move(place)) {}

  [[nodiscard]] bool is_null() const { return json_->is_null(); }
  [[nodiscard]] bool is_missing() const { return json_ == &kMissing; }

  /// The value of a key; null where the key is missing.
  [[nodiscard]] Node operator[](const std::string& key) const {
    if (!json_->is_object()) fail("an object");
    const auto found = json_->find(key);
    return Node(found == json_->end() ? kMissing : *found,
                place_.empty() ? key : place_ + "." + key);
  }
  /// Whether a key is there and not null.
  [[nodiscard]] bool has(const std::string& key) const { return !(*this)[key].is_null(); }

  [[nodiscard]] bool is_number() const { return json_->is_number(); }
  [[nodiscard]] double number() const {
    if (!is_number()) fail("a number");
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
  /// As it stands, for who escapes it.
  [[nodiscard]] const std::string& verbatim() const {
    if (!json_->is_string()) fail("a text");
    return json_->get_ref<const std::string&>();
  }
  /// Without what a terminal would obey, its lines kept.
  [[nodiscard]] std::string text() const {
    std::string out;
    for (std::string_view rest = verbatim();;) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      out += printable(rest.substr(0, end), std::string::npos);
      if (end == rest.size()) return out;
      out += '\n';
      rest.remove_prefix(end + 1);
    }
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
    for (std::size_t i = 0; i < json_->size(); ++i) out.push_back(read(entry(i)));
    return out;
  }
  /// The entries of a list, none where it is null.
  [[nodiscard]] std::vector<Node> entries() const {
    if (is_null()) return {};
    return list([](const Node& each) { return each; });
  }
  [[nodiscard]] std::vector<std::string> texts() const {
    return list([](const Node& each) { return each.text(); });
  }
  [[nodiscard]] std::vector<double> numbers() const {
    if (!json_->is_array()) fail("a list");
    std::vector<double> out;
    out.reserve(json_->size());
    for (std::size_t i = 0; i < json_->size(); ++i)  // thousands: a place only where it is needed
      out.push_back((*json_)[i].is_number() ? (*json_)[i].get<double>()
                    : (*json_)[i].is_null() ? std::numeric_limits<double>::quiet_NaN()
                                            : entry(i).number());
    return out;
  }
  /// An object of numbers, in its order.
  [[nodiscard]] std::vector<std::pair<std::string, double>> named_numbers() const {
    if (!json_->is_object()) fail("an object of numbers");
    std::vector<std::pair<std::string, double>> out;
    for (const auto& [key, value] : json_->items())
      out.emplace_back(printable(key, std::string::npos), (*this)[key].number());
    return out;
  }

  [[nodiscard]] std::vector<std::string> keys() const {
    if (!json_->is_object()) fail("an object");
    std::vector<std::string> out;
    for (const auto& [key, value] : json_->items()) out.push_back(key);
    return out;
  }
  /// The value as JSON, in ASCII.
  [[nodiscard]] std::string json_text() const {
    if (is_missing()) fail("any value");
    return json_->dump(-1, ' ', true, Json::error_handler_t::replace);
  }

  [[noreturn]] void fail(const std::string& accepted) const {
    const std::string what = is_null() ? "is missing" : std::string("is ") + json_->type_name();
    throw DataError((place_.empty() ? "" : printable(place_, 80) + ": ") + what +
                    "; accepted: " + accepted);
  }

 private:
  [[nodiscard]] Node entry(std::size_t i) const {
    return Node((*json_)[i], place_ + "[" + std::to_string(i) + "]");
  }

  inline static const Json kMissing;

  const Json* json_;
  std::string place_;
};

inline constexpr std::string_view kColumnsSchema = "slideway.columns/1";

/// A document that --json wrote: brackets at most 32 deep, one of these schemas. @throws DataError
/// it is none
Json parse_document(std::string_view text, std::initializer_list<std::string_view> schemas);

/// What `read` makes of a document; what is wrong with it is said with its name in front.
template <typename Read>
auto read_document(std::string_view text, const std::string& name,
                   std::initializer_list<std::string_view> schemas, Read&& read) {
  try {
    const Json json = parse_document(text, schemas);
    return read(Node(json));
  } catch (const DataError& error) {
    throw DataError(name + ": " + error.what());
  }
}

}  // namespace slideway
