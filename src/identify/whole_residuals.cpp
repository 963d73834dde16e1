#include "whole_residuals.hpp"

#include "slideway/identify/departures.hpp"
#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

/// Directions of the shared columns that the data determine beside all others.
Eigen::MatrixXd shared_basis(const ColumnPlaces& places, const Compressed& compressed,
                             const Gates& gates) {
  Eigen::MatrixXd beside = compressed.triangle(Eigen::all, places.shared),
                  own = compressed.triangle(Eigen::all, places.own);
  clear_rounding(own, compressed.scale(places.own));
  project_out(orthonormal(std::move(own)), beside);
  return analyse_rank(beside, compressed.scale(places.shared), gates.rank_tolerance).basis;
}

}  // namespace

WholeResiduals::WholeResiduals(const Linearisation& linear, const std::vector<Noise>& noise,
                               const Gates& gates)
    : linear_(linear),
      places_(linear),
      basis_(shared_basis(places_, compress(linear, noise), gates)) {}

LinearProfile WholeResiduals::of(std::size_t i, const Eigen::MatrixXd& suspect) const {
  const Observation& observation = *linear_.observations[i];
  LinearProfile out{observation.nuisances, linear_.columns[i](Eigen::all, places_.shared) * basis_,
                    places_.residuals[i], observation.profile->standard_uncertainty};
  append_columns(out.nuisances, places_.free[i]);
  append_columns(out.nuisances, directions_of_causes(linear_, i));
  if (suspect.cols() > 0) append_columns(out.nuisances, suspect);
  if (out.nuisances.cols() > observation.nuisances.cols())
    out.nuisances = orthonormal(std::move(out.nuisances));
  out.bounded = places_.bounded[i];
  return out;
}

Eigen::MatrixXd WholeResiduals::priors() const {
  const Eigen::MatrixXd rows = linear_.prior_rows(places_.priors, places_.shared) * basis_;
  return rows.transpose() * rows;
}

}  // namespace slideway
