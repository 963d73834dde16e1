#include "slideway/identify/departures.hpp"

#include <Eigen/SVD>
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

std::vector<Departing> departing_terms(const Model& model, bool of_law) {
  std::vector<Departing> out;
  for (const ModelTerm& term : model.terms)
    if (Departures by = term.effect->departures(); by.of_law == of_law && !by.parts.empty())
      out.push_back({&term, std::move(by)});
  return out;
}

/// Columns of the parts of one term's departures at a size, in each low band.
std::vector<Eigen::MatrixXd> columns_at(const Model& model, const Linearisation& linear,
                                        const Departing& departing, std::span<const double> shape,
                                        double size) {
  std::vector<Eigen::MatrixXd> out;
  for (const Observation* observation : linear.observations) {
    Eigen::MatrixXd& columns = out.emplace_back(
        Eigen::MatrixXd::Zero(observation->values.size(), std::ssize(departing.by.parts)));
    if (departing.term->acts_on(*observation->profile))
      columns = size * columns_at_values(departing.by.parts, *observation, model.machine, shape);
  }
  return out;
}

/// The same at its fitted size.
std::vector<Eigen::MatrixXd> columns_of(const Model& model, const Linearisation& linear,
                                        const Estimate& estimate, const Departing& departing) {
  const ModelTerm& term = *departing.term;
  const double size = (departing.by.of_law ? model.gates.drift_bend : 1.0) *
                      estimate.amplitudes[term.first_amplitude];
  return columns_at(model, linear, departing, shapes_of(term, estimate.shapes), size);
}

}  // namespace

std::vector<Eigen::MatrixXd> errors_of_causes(const Model& model, const Linearisation& linear,
                                              const Estimate& estimate) {
  std::vector<Eigen::MatrixXd> out;
  for (const Departing& each : departing_terms(model, false)) {
    std::vector<Eigen::MatrixXd> own = columns_of(model, linear, estimate, each);
    for (std::size_t i = 0; i < out.size(); ++i) append_columns(out[i], own[i]);
    if (out.empty()) out = std::move(own);
  }
  return out;
}

std::vector<Eigen::MatrixXd> errors_of_cause(const Model& model, const Linearisation& linear,
                                             const ModelTerm& term, std::span<const double> shape,
                                             double amplitude) {
  Departures by = term.effect->departures();
  if (by.of_law || by.parts.empty()) return {};
  return columns_at(model, linear, {&term, std::move(by)}, shape, amplitude);
}

Eigen::MatrixXd directions_of_causes(const Eigen::MatrixXd& errors, Eigen::VectorXd residual) {
  if (errors.cols() == 0) return errors;
  const Eigen::BDCSVD<Eigen::MatrixXd> parts(errors, Eigen::ComputeThinU);
  const Eigen::VectorXd& sizes = parts.singularValues();
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k < std::min(sizes.size(), residual.size() / 2); ++k) {
    project_out(parts.matrixU().col(k), residual);
    const auto left = static_cast<double>(residual.size() - k - 1);
    if (sizes[k] > residual.norm() / std::sqrt(left)) count = k + 1;
  }
  return parts.matrixU().leftCols(count);
}

Eigen::MatrixXd directions_of_causes(const Linearisation& linear, std::size_t observation) {
  const Eigen::VectorXd& residual = linear.residuals[observation];
  if (linear.errors_of_causes.empty()) return {residual.size(), 0};
  return directions_of_causes(linear.errors_of_causes[observation], residual);
}

DepartureResponse response_to_departures(const Model& model, const Linearisation& linear,
                                         const std::vector<Noise>& noise, const Estimate& estimate,
                                         const Eigen::MatrixXd& basis) {
  const std::vector<Departing> laws = departing_terms(model, true);
  if ((laws.empty() && linear.errors_of_causes.empty()) || basis.cols() == 0) return {};
  const Eigen::Index priors = linear.prior_rows.rows();
  Eigen::Index rows = priors;
  for (const Observation* observation : linear.observations) rows += observation->values.size();
  const auto white = [&](Eigen::Index columns, auto&& of_observation) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, columns);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < linear.observations.size(); ++i) {
      auto own = out.middleRows(row, linear.observations[i]->values.size());
      own = of_observation(i);
      noise[i].whiten(own);
      row += own.rows();
    }
    return out;
  };
  Eigen::MatrixXd design =
      white(basis.cols(), [&](std::size_t i) { return linear.columns[i] * basis; });
  design.bottomRows(priors) = linear.prior_rows * basis;
  const ProfileBases levelling = own_bases(linear.observations, noise);
  levelling.take_out(design);
  const auto response = [&](const std::vector<Eigen::MatrixXd>& columns) -> Eigen::MatrixXd {
    return basis * (design.transpose() *
                    white(columns.front().cols(), [&](std::size_t i) { return columns[i]; }));
  };
  DepartureResponse out{Eigen::MatrixXd(basis.rows(), 0), Eigen::MatrixXd(basis.rows(), 0)};
  if (!linear.errors_of_causes.empty()) out.to_causes = response(linear.errors_of_causes);
  for (const Departing& each : laws)
    append_columns(out.to_laws, response(columns_of(model, linear, estimate, each)));
  return out;
}

}  // namespace slideway
