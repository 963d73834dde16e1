#pragma once

#include <string_view>

/// The parts of the page that are the same in every report, embedded at build time.
namespace slideway::page {

extern const std::string_view kStyle;        // page/report.css
extern const std::string_view kChartStyle;   // dygraphs' own
extern const std::string_view kChartScript;  // dygraphs, with its licence
extern const std::string_view kScript;       // page/report.js

}  // namespace slideway::page
