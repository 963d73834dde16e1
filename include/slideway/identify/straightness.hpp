#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "slideway/identify/fit.hpp"

/// Straightness as ISO 230-1:2012 evaluates it: deviations from a stated reference line.
namespace slideway {

/// A reference line in the plane of the deviations: height(x) = at_zero + slope x.
struct ReferenceLine {
  std::string name;  // "end-point" | "least squares" | "minimum zone"
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

/// The one of least squares alone.
ReferenceLine least_squares_line(const Eigen::VectorXd& positions, const Eigen::VectorXd& heights);

/// Straightness of the slide the fit has found, E_ZX, with its uncertainty.
struct IdentifiedStraightness {
  struct Error {
    std::string line;
    double error_um = 0.0, highest_um = 0.0, highest_at_mm = 0.0, lowest_um = 0.0,
           lowest_at_mm = 0.0;
    double standard_uncertainty_um = 0.0, expanded_uncertainty_um = 0.0, coverage_factor = 2.0;
  };
  std::vector<double> position_mm;              // slide coordinate x
  std::vector<double> deviation_um;             // from the least-squares line
  std::vector<double> expanded_uncertainty_um;  // of the deviation
  std::vector<Error> errors;                    // one for each reference line
  std::string reason;                           // why there is none; then all else is empty
};

/// Variance that row * (amplitudes, shapes) has beside what the fit knows of.
using MoreVariance = std::function<double(const Eigen::RowVectorXd& row)>;

/// None where the model has no straightness.
std::optional<IdentifiedStraightness> identified_straightness(const Model& model,
                                                              const Solution& fit,
                                                              const MoreVariance& more = {});

}  // namespace slideway
