#include "departures.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "slideway/identify/linear_algebra.hpp"
#include "slideway/identify/profile_bases.hpp"

namespace slideway {
namespace {

/// A term of the model and what it may differ by.
struct Departing {
  const ModelTerm* term = nullptr;
  Departures by;
};

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

/// Columns of the parts of one term's departures at its fitted size, in all low bands, white.
Eigen::MatrixXd columns_of(const Model& model, const Linearisation& linear,
                           const std::vector<Noise>& noise, const Estimate& estimate,
                           const Departing& departing, Eigen::Index rows) {
  const ModelTerm& term = *departing.term;
  const double size = (departing.by.of_law ? model.gates.drift_bend : 1.0) *
                      estimate.amplitudes[term.first_amplitude];
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, std::ssize(departing.by.parts));
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    const Eigen::Index count = observation.values.size();
    if (term.acts_on(*observation.profile)) {
      out.middleRows(row, count) =
          size * columns_at_values(departing.by.parts, observation, model.machine,
                                   shapes_of(term, estimate.shapes));
      noise[i].whiten(out.middleRows(row, count));
    }
    row += count;
  }
  return out;
}

}  // namespace

DepartureResponse response_to_departures(const Model& model, const Linearisation& linear,
                                         const std::vector<Noise>& noise, const Estimate& estimate,
                                         const Eigen::MatrixXd& basis) {
  std::vector<Departing> all;
  for (const ModelTerm& term : model.terms)
    if (Departures by = term.effect->departures(); !by.parts.empty())
      all.push_back({&term, std::move(by)});
  if (all.empty() || basis.cols() == 0) return {};
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
  DepartureResponse out{Eigen::MatrixXd(basis.rows(), 0), Eigen::MatrixXd(basis.rows(), 0)};
  for (const Departing& each : all)
    append_columns(each.by.of_law ? out.to_laws : out.to_causes,
                   basis * (design.transpose() *
                            columns_of(model, linear, noise, estimate, each, design.rows())));
  return out;
}

}  // namespace slideway
