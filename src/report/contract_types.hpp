#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "slideway/base/record.hpp"

namespace slideway {

template <typename T>
inline constexpr bool kIsOptional = false;
template <typename T>
inline constexpr bool kIsOptional<std::optional<T>> = true;

template <typename T>
inline constexpr bool kIsList = false;
template <typename T>
inline constexpr bool kIsList<std::vector<T>> = true;
template <typename T>
inline constexpr bool kIsList<std::vector<std::pair<std::string, T>>> = false;

/// A struct without members of its own names: an object with any keys.
template <typename T>
inline constexpr bool kIsMap = false;
template <typename T>
inline constexpr bool kIsMap<std::map<std::string, T>> = true;
template <typename T>
inline constexpr bool kIsMap<std::vector<std::pair<std::string, T>>> = true;

/// The type of what a key of an object of that type holds; both kinds of kIsMap have pairs.
template <typename T>
using MappedType = typename T::value_type::second_type;

/// The type of a member, given its field.
template <typename T, typename Access>
using MemberType = std::remove_cvref_t<std::invoke_result_t<const Access&, T&>>;

}  // namespace slideway
