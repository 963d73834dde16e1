#pragma once

#include <string_view>

/// dygraphs, embedded at build time with its licence.
namespace slideway::page {

extern const std::string_view kChartStyle;
extern const std::string_view kChartScript;

}  // namespace slideway::page
