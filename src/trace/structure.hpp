#pragma once

#include <cmath>

#include "slideway/identify/gates.hpp"
#include "slideway/trace/trace.hpp"
#include "whitened.hpp"

namespace slideway {

/// What the slow band of the profiles holds outside the model, against what noise leaves there.
///
/// The square found in q orthonormal slow directions is, under noise alone, near a gamma variable
/// with the moments of Σ_i s_i χ²(q_i): s_i is lognormal, for the long-run variance of profile i's
/// noise is estimated, and measured in a faster band (Gates::noise_extrapolation).
struct LackOfFit {
  double p_value = 1.0;
  double ratio = 1.0;  // square found over square expected
  /// Structure, not noise.
  [[nodiscard]] bool significant(const Gates& gates) const;
};
LackOfFit lack_of_fit(const Whitened& data, const Linearisation& linear, const Gates& gates = {});

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
