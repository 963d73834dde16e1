#pragma once

#include <Eigen/Core>

namespace slideway {

/// Frequency (cycles per value) of a line that stands out of the spectrum around it, or 0. The
/// spectrum of smooth noise over its local level is exponential; the level is the median of the
/// neighbours over ln 2.
/// @param middle  first value of the near half of a diameter, or 0
double outstanding_line(const Eigen::VectorXd& values, Eigen::Index middle, double false_line);

/// The line, each half of a diameter with a phase of its own.
Eigen::MatrixXd line_on(Eigen::Index values, Eigen::Index middle, double cycles_per_value);

}  // namespace slideway
