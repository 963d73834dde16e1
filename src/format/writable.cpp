#include "writable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/base/units.hpp"

namespace slideway {
namespace {

[[noreturn]] void refuse(std::string_view format, const std::string& why) {
  throw UsageError("cannot write " + std::string(format) + ": " + why);
}

bool is_even(const std::vector<double>& positions, double spacing) {
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double allowed = std::max(1e-9 * spacing, kRounding * std::abs(positions[i]));
    if (!(std::abs(positions[i] - static_cast<double>(i) * spacing) <= allowed)) return false;
  }
  return true;
}

}  // namespace

void check_lengths(const Trace& trace, std::string_view format) {
  if (trace.positions.empty() || trace.positions.size() != trace.values.size())
    refuse(format, "there are " + std::to_string(trace.positions.size()) + " positions and " +
                       std::to_string(trace.values.size()) + " values");
  for (const std::string* unit : {&trace.position_unit, &trace.value_unit})
    if (!length_unit(*unit))
      refuse(format, "the unit '" + printable(*unit) +
                         "' is no length; accepted: " + std::string(kLengthUnits));
  for (const double position : trace.positions)
    if (!std::isfinite(position)) refuse(format, "a position is missing");
  for (const double value : trace.values)
    if (std::isinf(value)) refuse(format, "a value is infinite");
}

void check_complete(const Trace& trace, std::string_view format) {
  const auto missing = std::find_if(trace.values.begin(), trace.values.end(),
                                    [](double value) { return std::isnan(value); });
  if (missing != trace.values.end())
    refuse(format, "point " + std::to_string(missing - trace.values.begin() + 1) +
                       " is missing, which the format cannot say; X3P, SDF and text can");
}

double spacing_from_zero(const Trace& trace, std::string_view format) {
  const std::vector<double>& x = trace.positions;
  if (x.size() > 1 && x[0] == 0.0)
    for (const double spacing : {x[1], x.back() / static_cast<double>(x.size() - 1)})
      if (spacing > 0.0 && is_even(x, spacing)) return spacing;
  refuse(format, "it holds positions at an even spacing from 0, these run from " +
                     shortest(x.front()) + " to " + shortest(x.back()) +
                     " unevenly or not from 0; X3P and text hold any");
}

double converted(double length, std::string_view from, std::string_view to) {
  if (from == to) return length;
  const UnitScale scale = length_unit(from).value();
  const UnitScale back = length_unit(to).value();
  const double up = scale.factor * back.divisor;
  const double down = scale.divisor * back.factor;
  return up >= down ? length * (up / down) : length / (down / up);
}

void refuse_line(const TraceRequest& request, std::string_view format) {
  if (!request.line.empty())
    throw UsageError("line = \"" + printable(request.line) + "\": " + std::string(format) +
                     " holds one profile, there is no line to choose");
}

}  // namespace slideway
