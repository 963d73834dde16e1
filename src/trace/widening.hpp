#pragma once

#include "search_round.hpp"
#include "structure.hpp"

namespace slideway {

/// What is left and has no name widens uncertainties: by what the process that describes it could
/// put into a fit unseen, and by the largest change that one of the effects refused in spite of
/// their gain would bring (a rectangular distribution of that half width).
struct Widening {
  Eigen::MatrixXd process;  // of (amplitudes, shapes), a column each standard deviation
  Eigen::MatrixXd refused;  // the same, a column each effect

  /// Of row * (amplitudes, shapes).
  [[nodiscard]] double variance(const Eigen::RowVectorXd& row) const;
};

Widening widening(const Model& model, const Solution& fit, const Structure& structure,
                  const std::vector<TestedCandidate>& refused);

}  // namespace slideway
