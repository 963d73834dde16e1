#pragma once

#include "slideway/identify/gates.hpp"
#include "slideway/identify/noise.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

/// What the slow band of the profiles holds outside the model, against what noise leaves there.
///
/// The square found in q slow directions is, under noise alone, near a gamma variable with the
/// moments of Σ_i s_i χ²(q_i): s_i is lognormal, for the long-run variance of profile i's noise is
/// estimated, its memory together with that of its pool, and measured in a faster band
/// (Gates::noise_extrapolation).
struct LackOfFit {
  double p_value = 1.0;
  double ratio = 1.0;  // square found over square expected
  /// Structure, not noise.
  [[nodiscard]] bool significant(const Gates& gates) const;
};

/// @param linear  at the estimate under this noise
LackOfFit lack_of_fit(const Linearisation& linear, const std::vector<Noise>& noise,
                      const Gates& gates = {});

}  // namespace slideway
