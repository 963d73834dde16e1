#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "slideway/signal/exponential_mixture.hpp"

namespace slideway {

/// Neighbours without a gap: the first index, and how many.
using Run = std::pair<Eigen::Index, Eigen::Index>;

/// Means of 2^octaves neighbours in each run of the rows; what is left over at the end of a run is
/// dropped.
Eigen::MatrixXd block_means(const Eigen::MatrixXd& rows, const std::vector<Run>& runs, int octaves);

/// What a series says of a stationary noise beside its block means (block_means()), octave by
/// octave: -2 ln of a likelihood without a pass over the series.
///
/// At each octave, segments of 64 values are taken into cosines (DCT-II, orthonormal), of which the
/// upper half is kept: the mean squares of j = 32 ... 63. Then neighbours are taken together in
/// pairs. With the block means at the end this is a number for each value of the series. The
/// variance of each cosine is exact; what cosines have in common is neglected (Whittle 1953).
class OctavePowers {
 public:
  OctavePowers(const Eigen::VectorXd& series, const std::vector<Run>& runs, int octaves);

  /// Σ ln f and Σ x² / f over the cosines x, with their variances f under a noise of the series.
  struct Fit {
    double log_determinant = 0.0, square = 0.0;
  };
  [[nodiscard]] Fit under(const ExponentialMixture& noise) const;

  /// Cosines in all.
  [[nodiscard]] double count() const;

 private:
  struct Octave {
    Eigen::ArrayXd mean_square;  // of each j
    double segments = 0.0;
  };
  std::vector<Octave> octaves_;
};

}  // namespace slideway
