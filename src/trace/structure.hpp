#pragma once

#include "slideway/trace/trace.hpp"
#include "whitened.hpp"

namespace slideway {

/// What the slow band of the profiles holds outside the model, against what noise leaves there
/// (parametric bootstrap, gamma distribution through its moments).
struct LackOfFit {
  double p_value = 1.0;
  double ratio = 1.0;  // square found over square expected
  /// Structure, not noise: p below 0.001, and more than twice what is expected; below the band it
  /// was measured in, the spectrum of the noise is an extrapolation.
  [[nodiscard]] bool significant() const { return p_value < 1e-3 && ratio > 2.0; }
};
LackOfFit lack_of_fit(const Whitened& data, const Linearisation& linear);

/// -2 ln evidence a Gaussian process on its best clock gains over noise alone.
double process_gain(const Model& model, const Whitened& data, const Linearisation& linear);

/// Describes what is left: a Gaussian process (Matérn 3/2, in cosines of the clock) outside the
/// model's span, on the clock with the largest evidence, or one of its own in every profile.
Unnamed describe_structure(const Model& model, const Whitened& data, const Linearisation& linear);

}  // namespace slideway
