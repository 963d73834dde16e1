#pragma once

#include <cmath>

#include "slideway/trace/trace.hpp"
#include "whitened.hpp"

namespace slideway {

/// A Gaussian process (Matérn 3/2, in cosines of a clock) outside the model's span, on the clock
/// with the largest evidence, or one of its own in every profile.
struct Structure {
  Unnamed description;                   // clock and evidence only
  double log_evidence = -INFINITY;       // over noise alone
  std::vector<Eigen::MatrixXd> columns;  // cosines, per fitted profile
  Eigen::VectorXd sizes;                 // of their coefficients: standard deviations
  Eigen::VectorXd coefficients;          // as the data have them

  /// What it gains over noise alone, in BIC's measure.
  [[nodiscard]] double gain() const { return 2.0 * log_evidence; }
};
Structure find_structure(const Model& model, const Whitened& data, const Linearisation& linear);

/// Size, place and form of what is left.
Unnamed describe(const Structure& structure, const Whitened& data, const Linearisation& linear);

}  // namespace slideway
