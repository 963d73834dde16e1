#pragma once

#include <string>
#include <string_view>

#include "slideway/format/format.hpp"

/// What the standard formats ask of a trace before it is written.
namespace slideway {

/// @throws UsageError unless the trace has as many positions as values, at least one, finite
///         positions, and both in length units
void check_lengths(const Trace& trace, std::string_view format);

/// @throws UsageError if a value is missing
void check_complete(const Trace& trace, std::string_view format);

/// The spacing of positions that start at 0 and are even but for rounding.
/// @throws UsageError if they are not
double spacing_from_zero(const Trace& trace, std::string_view format);

/// A length in another of kLengthUnits, one rounding for units apart by a power of ten.
double converted(double length, std::string_view from, std::string_view to);

/// @throws UsageError if a line is asked for in a file that holds one profile only
void refuse_line(const TraceRequest& request, std::string_view format);

}  // namespace slideway
