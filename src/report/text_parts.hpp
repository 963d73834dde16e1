#pragma once

#include <string>

#include "slideway/trace/details.hpp"
#include "slideway/trace/trace.hpp"

namespace slideway {

std::string heading(const std::string& text);
std::string item(const std::string& text);
std::string note(const std::string& text);

/// @throws std::logic_error if it is not finite
std::string number(double value, int digits);
std::string probability(double p);
/// "um" as µm.
std::string unit_text(const std::string& unit);

/// The `trace` part of the report.
std::string trace_text(const TraceResult& trace);

/// The residual of the profile in which the loop has lowered it most, before and after; "" where it
/// has not.
std::string residual_pictures(const Details& details);

}  // namespace slideway
