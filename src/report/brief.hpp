#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slideway {

inline constexpr std::string_view kBriefSchema = "slideway.brief/1";

/// Significant digits a brief report writes of the numbers in a member of a record; 0: the member
/// is left out.
int brief_digits(std::string_view record, std::string_view key);

/// The records it has members of, and the keys it has of one.
std::vector<std::string_view> brief_names();
std::vector<std::string> brief_keys(std::string_view record);

}  // namespace slideway
