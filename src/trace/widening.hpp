#pragma once

#include "search_round.hpp"
#include "structure.hpp"

namespace slideway {

/// What else could be in the data widens uncertainties: by what the process that describes what is
/// left could put into a fit unseen, and by the largest change that one of the effects refused in
/// spite of their gain, or one of the rivals in the place of an accepted effect, would bring, or
/// the absence of an accepted one would (a rectangular distribution of that half width).
struct Widening {
  Eigen::MatrixXd process;  // of (amplitudes, shapes), a column each standard deviation
  Eigen::MatrixXd changes;  // the same, a column each effect

  /// By nothing. @param numbers  amplitudes and shapes
  explicit Widening(Eigen::Index numbers) : process(numbers, 0), changes(numbers, 0) {}

  /// By what the numbers are without an effect.
  void add_absence(const FittedModel& fitted, const FittedModel& without);
  /// @param fitted   the model that is widened
  /// @param without  it without the effect whose rivals these are
  void add_rivals(const FittedModel& fitted, const FittedModel& without,
                  const std::vector<const TestedCandidate*>& rivals);

  /// By what the law of a rival may differ by.
  void add_bend(const FittedModel& fitted, const FittedModel& without, const Refined& rival);

  /// Of row * (amplitudes, shapes).
  [[nodiscard]] double variance(const Eigen::RowVectorXd& row) const;

  /// Further changes, a column each.
  void add(const Eigen::MatrixXd& more);
};

Widening widening(const Model& model, const Solution& fit, const Structure& structure,
                  const std::vector<TestedCandidate>& refused);

}  // namespace slideway
