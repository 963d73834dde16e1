#include "error_of_causes.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/profile_bases.hpp"

namespace slideway {
namespace {

constexpr auto kDraws = static_cast<Eigen::Index>(kDrawsOfCause);

/// Columns of effects of one amplitude at the places of the low-band values, whose spacing is that
/// which a measured cause is averaged over, side by side.
Eigen::MatrixXd columns_at_values(const std::vector<std::unique_ptr<Effect>>& effects,
                                  const Observation& observation, const Machine& machine,
                                  std::span<const double> shape) {
  const Profile& profile = *observation.profile;
  std::vector<double> positions = observation.low_band.positions(profile.positions);
  const bool falls = positions.front() > positions.back();
  std::ranges::sort(positions);
  const Stations stations(positions, profile.setup, machine);
  Eigen::MatrixXd out(stations.size(), std::ssize(effects));
  for (std::size_t i = 0; i < effects.size(); ++i)
    effects[i]->columns(stations, shape, out.middleCols(static_cast<Eigen::Index>(i), 1));
  out *= low_band_scale(observation);
  if (falls) return out.colwise().reverse();
  return out;
}

/// Columns of draws of one term's error at its fitted size, in all low bands, white.
Eigen::MatrixXd errors_of(const Model& model, const Linearisation& linear,
                          const std::vector<Noise>& noise, const Estimate& estimate,
                          const ModelTerm& term, Eigen::Index rows) {
  std::vector<std::unique_ptr<Effect>> draws;
  for (std::size_t d = 0; d < kDrawsOfCause; ++d) draws.push_back(term.effect->error_of_cause(d));
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, kDraws);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    const Eigen::Index count = observation.values.size();
    if (term.acts_on(*observation.profile)) {
      out.middleRows(row, count) =
          estimate.amplitudes[term.first_amplitude] *
          columns_at_values(draws, observation, model.machine, shapes_of(term, estimate.shapes));
      noise[i].whiten(out.middleRows(row, count));
    }
    row += count;
  }
  return out;
}

}  // namespace

Eigen::MatrixXd response_to_causes(const Model& model, const Linearisation& linear,
                                   const std::vector<Noise>& noise, const Estimate& estimate,
                                   const Eigen::MatrixXd& basis) {
  std::vector<const ModelTerm*> terms;
  for (const ModelTerm& term : model.terms)
    if (term.effect->description().measured) terms.push_back(&term);
  if (terms.empty() || basis.cols() == 0) return {};
  Eigen::Index values = 0;
  for (const Observation* observation : linear.observations) values += observation->values.size();
  Eigen::MatrixXd design(values + linear.prior_rows.rows(), basis.cols());
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Eigen::Index count = linear.observations[i]->values.size();
    design.middleRows(row, count) = linear.columns[i] * basis;
    noise[i].whiten(design.middleRows(row, count));
    row += count;
  }
  design.bottomRows(linear.prior_rows.rows()) = linear.prior_rows * basis;
  const ProfileBases levelling = own_bases(linear.observations, noise);
  levelling.take_out(design);
  Eigen::MatrixXd out(basis.rows(), kDraws * std::ssize(terms));
  for (std::size_t k = 0; k < terms.size(); ++k)
    out.middleCols(static_cast<Eigen::Index>(k) * kDraws, kDraws) =
        basis *
        (design.transpose() * errors_of(model, linear, noise, estimate, *terms[k], design.rows()));
  return out / std::sqrt(static_cast<double>(kDraws));
}

}  // namespace slideway
