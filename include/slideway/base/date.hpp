#pragma once

#include <chrono>
#include <optional>
#include <string_view>

namespace slideway {

/// The day that "2026-11-21" (ISO 8601) names; nothing for any other text and for a day that no
/// calendar has.
std::optional<std::chrono::year_month_day> parse_date(std::string_view text);

}  // namespace slideway
