#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

/// What the program writes and reads back, as lists: the texts of an enumeration, the members of a
/// struct. All that has to know every member of a result (the JSON writer and reader, the JSON
/// Schema, the Python classes, the search for numbers that are not finite) goes through these
/// lists.
namespace slideway {

/// Texts of an enumeration, in the order of its enumerators, which count from 0.
template <typename Enum>
inline constexpr std::array<std::string_view, 0> kTexts{};

template <typename Enum>
concept Named = std::is_enum_v<Enum> &&(kTexts<Enum>.size() > 0);

template <Named Enum>
constexpr std::string_view text_of(Enum value) {
  return kTexts<Enum>[static_cast<std::size_t>(value)];
}

template <Named Enum>
constexpr std::optional<Enum> from_text(std::string_view text) {
  for (std::size_t i = 0; i < kTexts<Enum>.size(); ++i)
    if (kTexts<Enum>[i] == text) return static_cast<Enum>(i);
  return std::nullopt;
}

/// One member: its key, how to get at it (a pointer to member, or a function of the struct that
/// returns a reference), and what it means, for who reads a report.
template <typename Access>
struct Field {
  std::string_view key;
  Access access;
  std::string_view doc;
  int digits;  // significant ones that are written of each number; 0: all; kJsonText: see there
};

/// Digits of a text that is JSON already.
inline constexpr int kJsonText = -1;

template <typename Access>
constexpr Field<Access> field(std::string_view key, Access access, std::string_view doc = "") {
  return {key, access, doc, 0};
}

/// A member that is there to be drawn.
template <typename Access>
constexpr Field<Access> drawn(std::string_view key, Access access, std::string_view doc = "",
                              int digits = 5) {
  return {key, access, doc, digits};
}

template <typename Access>
constexpr Field<Access> json_text(std::string_view key, Access access, std::string_view doc = "") {
  return {key, access, doc, kJsonText};
}

/// All members of a struct, in the order they are written in.
template <typename... Accesses>
struct Record {
  std::string_view name;  // of its class in Python, of its definition in the schema
  std::string_view doc;
  std::tuple<Field<Accesses>...> fields;
};

template <typename... Accesses>
constexpr Record<Accesses...> record(std::string_view name, std::string_view doc,
                                     Field<Accesses>... fields) {
  return {name, doc, {fields...}};
}

/// The list of a struct; specialised for each that is part of a report.
template <typename T>
inline constexpr std::nullptr_t kRecord = nullptr;

template <typename T>
concept Recorded = !std::is_null_pointer_v<std::remove_cv_t<decltype(kRecord<T>)>>;

/// Calls `each(field)` for every member of T.
template <Recorded T, typename Each>
constexpr void for_each_field(Each&& each) {
  std::apply([&](const auto&... fields) { (each(fields), ...); }, kRecord<T>.fields);
}

}  // namespace slideway
