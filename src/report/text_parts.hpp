#pragma once

#include <string>

#include "slideway/trace/analysis.hpp"

namespace slideway {

std::string heading(const std::string& text);
std::string item(const std::string& text);
std::string note(const std::string& text);

/// "-" where it is not finite.
std::string number(double value, int digits);
std::string probability(double p);
/// "um" as µm.
std::string unit_text(const std::string& unit);

/// The closed loop. REQUIRES that it was run.
std::string trace_text(const Analysis& analysis);

/// The residual of the profile in which the loop has lowered it most, before and after; "" where it
/// has not.
std::string residual_pictures(const Curves& curves);

}  // namespace slideway
