#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slideway/trace/analysis.hpp"

namespace slideway {

/// What a result says about X to a numerical control: errors (actual minus nominal position of the
/// tool tip), axes as in ISO 841, mm and rad. The tool is off in Z by
/// E_ZX(x) - B0X (x - x_0), up to a constant.
struct Compensation {
  /// Slide coordinate, evenly spaced over the travel that was measured: the report's own, where a
  /// bridge counts from foot to foot.
  std::vector<double> positions_mm;
  /// E_ZX at the positions, from the line through its end points; empty: left out.
  std::vector<double> straightness_mm;
  std::vector<double> straightness_U_mm;  // expanded uncertainty, of each
  /// B0X: squareness of X to the spindle axis, of that line: Δβxz minus the line's slope.
  std::optional<double> squareness_rad;
  double interpolation_mm = 0.0;      // largest error of linear interpolation between positions
  std::vector<std::string> basis;     // what the numbers are made of, one line each
  std::vector<std::string> left_out;  // what is left out or in doubt, and why
};

/// @param step_mm  largest distance of two positions; 0: a fiftieth of the travel
/// @throws DataError   neither straightness nor squareness is fit to be loaded, with the reasons
/// @throws UsageError  the step is not finite, negative, or makes more than 5000 positions
Compensation compensation(const Analysis& analysis, double step_mm = 0.0);

/// What the table can be written for.
const std::vector<std::string>& compensation_formats();

/// @throws UsageError  none of compensation_formats()
void check_compensation_format(const std::string& format);

/// The table in the format of a control, with units, signs and what its operator has to set as
/// comments. `source` is named in the first comment.
/// @throws UsageError  heidenhain: more than its 256 positions
std::string compensation_table(const Compensation& table, const std::string& format,
                               const std::string& source);

/// What is to be said beside the table: what is left out or in doubt and, for a format without
/// comments (heidenhain), all that others hold as comments. One line each.
std::vector<std::string> compensation_notes(const Compensation& table, const std::string& format,
                                            const std::string& source);

}  // namespace slideway
