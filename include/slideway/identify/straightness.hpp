#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "slideway/identify/fit.hpp"

/// Straightness as ISO 230-1:2012 evaluates it: deviations from a stated reference line.
namespace slideway {

/// A reference line in the plane of the deviations: height(x) = at_zero + slope x.
struct ReferenceLine {
  ReferenceLineKind kind = ReferenceLineKind::end_point;
  double at_zero = 0.0, slope = 0.0;
  /// Derivatives of the straightness error (largest deviation minus smallest) by the heights, the
  /// points it rests on held.
  Eigen::RowVectorXd sensitivity;
  double error = 0.0, highest = 0.0, lowest = 0.0;
  std::size_t highest_at = 0, lowest_at = 0;  // indices
};

/// The three lines of ISO 230-1. Positions rising, at least two; heights and error have one unit.
std::vector<ReferenceLine> reference_lines(const Eigen::VectorXd& positions,
                                           const Eigen::VectorXd& heights);

/// None where the model has no straightness.
std::optional<Straightness> identified_straightness(const Model& model, const Solution& fit,
                                                    const MoreVariance& more = {});

}  // namespace slideway
