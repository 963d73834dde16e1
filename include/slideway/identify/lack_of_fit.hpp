#pragma once

#include "slideway/identify/gates.hpp"
#include "slideway/identify/noise.hpp"
#include "slideway/identify/solve.hpp"

namespace slideway {

/// What the slow band of the profiles holds outside the model, against what noise leaves there.
///
/// The square found in q slow directions is, under one noise, near a gamma variable with the
/// moments of Σ_i s_i Σ_j ρ_ij χ²(1): ρ_ij is the density of that noise at cosine j over that of
/// the most probable noise, and s_i the size of profile i, measured in a faster band
/// (Gates::noise_extrapolation). The probability of a larger square is the mean over the noises
/// that the residual allows.
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
