#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/column_places.hpp"
#include "slideway/identify/gates.hpp"
#include "slideway/identify/noise.hpp"

namespace slideway {

/// What profiles say of their noise in all of their values, the model left free.
class WholeResiduals {
 public:
  /// @param linear  outlives this
  /// @param noise   per fitted observation: what the shared columns are weighed by
  WholeResiduals(const Linearisation& linear, const std::vector<Noise>& noise, const Gates& gates);

  /// A profile, its own columns free and the shared ones in directions that the data determine.
  /// @param suspect  columns that are free besides
  [[nodiscard]] LinearProfile of(std::size_t i, const Eigen::MatrixXd& suspect = {}) const;

  /// Information of the priors on those directions.
  [[nodiscard]] Eigen::MatrixXd priors() const;

  /// Columns of the model that the data determine.
  [[nodiscard]] Eigen::Index determined() const { return basis_.cols() + std::ssize(places_.own); }

 private:
  const Linearisation& linear_;
  ColumnPlaces places_;
  Eigen::MatrixXd basis_;
};

}  // namespace slideway
