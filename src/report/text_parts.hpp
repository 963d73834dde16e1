#pragma once

#include <string>

#include "slideway/trace/trace.hpp"

namespace slideway {

std::string heading(const std::string& text);
std::string item(const std::string& text);
std::string note(const std::string& text);

/// @throws std::logic_error if it is not finite
std::string number(double value, int digits);
std::string probability(double p);

/// The `trace` part of the report.
std::string trace_text(const TraceResult& trace);

}  // namespace slideway
