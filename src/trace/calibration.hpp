#pragma once

#include <vector>

#include "search.hpp"
#include "slideway/identify/gates.hpp"

namespace slideway {

/// How large the best of all atoms gets where nothing is missing: the parametric bootstrap of the
/// sup statistic (the largest penalised gain over all candidates and shapes), its tail a Gumbel
/// distribution, or an extreme-value distribution of heavier tail where the resamples refute that
/// one: noise of a slope that is not known gives now and then far more than the rest. A p-value
/// from it knows the whole search.
struct Calibration {
  double location = 0.0, scale = 1.0;
  double shape = 0.0;      // k of Hosking, Wallis and Wood (1985), not positive; 0: Gumbel
  double of_others = 0.0;  // probability that the noise is another one than it was made for
  [[nodiscard]] double p_value(double penalised_gain) const;
  /// Penalised gain that noise exceeds with this probability.
  [[nodiscard]] double threshold(double significance) const;
};

/// The distribution of largest gains, at least three of them.
Calibration fit_extremes(std::vector<double> gains);

/// White residuals of data in which nothing is missing, outside the model's span. The noise of each
/// is drawn from what its estimate leaves open, and made white with the estimate itself.
Eigen::MatrixXd null_residuals(const Whitened& data, const Gates& gates);

/// Of any profile: that its noise is not the likeliest of those its residual allows.
double probability_of_others(const std::vector<Noise>& noise);

/// @param progress  as largest_gains()
Calibration calibrate(const Whitened& data, const Candidates& candidates, const Gates& gates = {},
                      const std::function<void(double)>& progress = {});

}  // namespace slideway
