#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/model_result.hpp"

namespace slideway {

/// A reference line in the plane of the deviations, and how it depends on the heights while the
/// points it rests on are held.
struct ReferenceLine {
  ReferenceLineKind kind = ReferenceLineKind::end_point;
  Eigen::Matrix2Xd of_heights;  // (height at position 0, slope) = of_heights * heights
  double error = 0.0, highest = 0.0, lowest = 0.0;
  std::size_t highest_at = 0, lowest_at = 0;  // indices

  /// From the line, of each position; the line of minimum zone lies along an edge of its strip.
  /// @param heights  any: one column each
  [[nodiscard]] Eigen::MatrixXd deviations(const Eigen::VectorXd& positions,
                                           const Eigen::MatrixXd& heights) const;
};

/// The three lines of ISO 230-1. Positions rising, at least two; heights and error have one unit.
std::vector<ReferenceLine> reference_lines(const Eigen::VectorXd& positions,
                                           const Eigen::VectorXd& heights);

/// The one through the ends alone.
ReferenceLine end_point_line(const Eigen::VectorXd& positions, const Eigen::VectorXd& heights);

/// The one of least squares alone.
ReferenceLine least_squares_line(const Eigen::VectorXd& positions, const Eigen::VectorXd& heights);

}  // namespace slideway
