#pragma once

#include <cmath>
#include <concepts>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "brief.hpp"
#include "slideway/base/record.hpp"

namespace slideway {

/// Writes records as JSON: keys in the order of the lists, doubles in their shortest form that
/// reads back (with as many digits as the field says), numbers of a list on one line, null for what
/// is absent or not finite. Bytes that are no UTF-8 are replaced. A brief one is on one line, has
/// the members and digits of brief_digits(), and no number, text or truth that is null, empty,
/// false or a count of 0.
class JsonWriter {
 public:
  enum class Layout { one_line, indented, brief };
  explicit JsonWriter(Layout layout)
      : indented_(layout == Layout::indented), brief_(layout == Layout::brief) {}

  template <Recorded T>
  void write(const T& object) {
    open('{');
    for_each_field<T>([&](const auto& field) {
      const auto& value = std::invoke(field.access, object);
      const int digits = brief_ ? brief_digits(kRecord<T>.name, field.key) : field.digits;
      if (brief_ && (digits == 0 || is_nothing(value))) return;
      key(field.key);
      digits_ = digits;
      is_probability_ = field.key == "p_value" || field.key.ends_with("_p");
      write(value);
    });
    close('}');
  }

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  void write(double number);
  void write(const std::string& text);
  void write(bool truth) { text_ += truth ? "true" : "false"; }
  void write(std::integral auto number) { text_ += std::to_string(number); }
  void write(Named auto value) { text_.append("\"").append(text_of(value)).append("\""); }

  template <typename T>
  void write(const std::optional<T>& value) {
    if (value)
      write(*value);
    else
      text_ += "null";
  }

  template <typename T>
  void write(const std::vector<T>& values) {
    const bool was_indented = indented_;
    const int digits = digits_;
    if constexpr (std::is_arithmetic_v<T>) indented_ = false;
    open('[');
    for (const T& value : values) {
      next();
      digits_ = digits;
      write(value);
    }
    close(']');
    indented_ = was_indented;
  }

  template <typename T>
  void write(const std::vector<std::pair<std::string, T>>& values) {
    write_object(values);
  }
  template <typename T>
  void write(const std::map<std::string, T>& values) {
    write_object(values);
  }
  void write_object(const auto& values) {
    open('{');
    for (const auto& [name, value] : values) {
      next();
      quote(name);
      text_ += indented_ ? ": " : ":";
      write(value);
    }
    close('}');
  }

  template <typename... T>
  void write(const std::tuple<T...>& values) {
    const bool was_indented = std::exchange(indented_, false);
    open('[');
    std::apply([&](const T&... value) { ((next(), write(value)), ...); }, values);
    close(']');
    indented_ = was_indented;
  }

  template <typename T>
  static bool is_nothing(const T& value) {
    if constexpr (std::integral<T>)
      return value == T{};
    else if constexpr (std::convertible_to<T, std::string_view>)
      return value.empty();
    else if constexpr (requires { value.has_value(); })
      return !Recorded<typename T::value_type> && !value.has_value();
    else
      return false;
  }

  void open(char bracket);
  void close(char bracket);
  /// Goes on to the next value of what is open.
  void next();
  void key(std::string_view name);
  void quote(std::string_view text);

  std::string text_;
  bool indented_, brief_, is_first_ = true;
  std::size_t depth_ = 0;
  int digits_ = 0;
  bool is_probability_ = false;
};

}  // namespace slideway
