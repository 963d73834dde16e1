#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "slideway/signal/dwt.hpp"

namespace slideway {

struct LowBandOptions {
  std::string wavelet = "db1";
  int level = 5;  // 0: no low band, the raw profile
  Boundary boundary = Boundary::symmetric;
};

/// Where stations lie more than so many of their usual steps apart is a gap between them: a station
/// that was left out makes two, rounded ones differ by less.
inline constexpr double kGapSteps = 1.9;

/// The level raised until so many samples leave at most so many values.
LowBandOptions with_at_most(LowBandOptions options, std::size_t samples, std::size_t values);

/// The low band of a profile as a linear operator: samples at given positions -> approximation
/// coefficients of the last level. Data and the model's columns go through the same operator, so
/// that neither block averaging nor the way to a uniform grid biases a fit.
///
/// Positions that are not uniform (spacing off by more than 1e-3 of the mean step) are first
/// brought to a uniform grid by linear interpolation: of the step they have but for their gaps,
/// where every step is a multiple of it, else of as many samples. Data and columns are interpolated
/// alike, so that a gap bends nothing; but what stands in it is no observation, nor is what the
/// boundary adds beyond the ends: see unmeasured().
class LowBand {
 public:
  /// @throws DataError  fewer samples than 2^level
  LowBand(const LowBandOptions& options, std::span<const double> positions);

  [[nodiscard]] const LowBandOptions& options() const { return options_; }
  [[nodiscard]] Eigen::Index samples() const { return samples_; }  // of the uniform grid
  [[nodiscard]] Eigen::Index values() const { return values_; }    // approximation coefficients
  [[nodiscard]] bool resampled() const { return !cell_.empty(); }

  /// Coefficients more than half of which comes from the inside of gaps, or more than a quarter
  /// from beyond the ends, rising.
  [[nodiscard]] const std::vector<Eigen::Index>& unmeasured() const { return unmeasured_; }

  /// The samples that some points of the uniform grid are made of: the first one, and how many.
  struct Samples {
    Eigen::Index first = 0, count = 0;
  };
  [[nodiscard]] Samples samples_of(Eigen::Index first_point, Eigen::Index points) const;

  /// Those points by linear interpolation, where positions are resampled().
  /// @param samples  those of samples_of()
  void bring_to_grid(std::span<const double> samples, Eigen::Index first_point,
                     std::span<double> grid) const;

  /// Samples -> #values coefficients. Scaled as the orthonormal transform has it: white noise
  /// keeps its standard deviation, a constant c becomes c * sqrt(2)^level.
  void apply(std::span<const double> signal, std::span<double> coefficients) const;

  /// apply() on every column.
  [[nodiscard]] Eigen::MatrixXd apply(const Eigen::MatrixXd& columns) const;

  /// Mean position of each coefficient: what apply() makes of the positions, back in mm.
  [[nodiscard]] std::vector<double> positions(std::span<const double> sample_positions) const;

  /// a_L at full length (on the uniform grid where there is one).
  [[nodiscard]] std::vector<double> reconstruct(std::span<const double> coefficients) const;

 private:
  struct Workspace;
  void apply(std::span<const double> signal, std::span<double> coefficients,
             Workspace& workspace) const;
  std::span<const double> transform(std::span<const double> grid, Boundary boundary,
                                    Workspace& workspace) const;
  [[nodiscard]] std::vector<double> shares(const std::vector<double>& samples,
                                           Boundary boundary) const;
  std::vector<double> lay_grid(std::span<const double> positions);
  void find_in_gaps(const std::vector<double>& inside_gaps, std::vector<char>& is_unmeasured) const;
  void find_beyond_ends(std::vector<char>& is_unmeasured) const;

  Wavelet wavelet_;
  LowBandOptions options_;
  Eigen::Index samples_ = 0;
  Eigen::Index values_ = 0;
  std::vector<Eigen::Index> cell_;  // left neighbour of each grid point; empty on a uniform grid
  std::vector<double> weight_;      // of the right neighbour
  std::vector<Eigen::Index> unmeasured_;
};

}  // namespace slideway
