#pragma once

#include <string_view>

#include "slideway/report/chart_library.hpp"

/// The parts of the page that are the same in every report, embedded at build time.
namespace slideway::page {

extern const std::string_view kStyle;   // page/report.css
extern const std::string_view kScript;  // page/report.js

}  // namespace slideway::page
