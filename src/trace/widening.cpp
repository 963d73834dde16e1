#include "widening.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

/// Change of (amplitudes, shapes) by signals in the low bands, a column each.
Eigen::MatrixXd response(const Solution& fit, const Eigen::MatrixXd& signals) {
  const Linearisation& linear = fit.linear;
  const Eigen::Index k = linear.prior_rows.cols();
  Eigen::Index nuisances = 0, next = 0;
  for (const Observation* observation : linear.observations)
    nuisances += observation->nuisances.cols();
  Eigen::MatrixXd design = stack(linear, k + nuisances, [&](std::size_t i) {
    const Observation& observation = *linear.observations[i];
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(observation.values.size(), k + nuisances);
    rows.leftCols(k) = linear.columns[i];
    rows.middleCols(k + next, observation.nuisances.cols()) = observation.nuisances;
    next += observation.nuisances.cols();
    return rows;
  });
  design.bottomLeftCorner(linear.prior_rows.rows(), k) = linear.prior_rows;
  Eigen::MatrixXd targets = signals;
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Eigen::Index count = linear.observations[i]->values.size();
    fit.noise[i].whiten(design.middleRows(row, count));
    fit.noise[i].whiten(targets.middleRows(row, count));
    row += count;
  }
  return least_squares(design, targets).values.topRows(k);
}

}  // namespace

double Widening::variance(const Eigen::RowVectorXd& row) const {
  const double change = refused.cols() > 0 ? (row * refused).cwiseAbs().maxCoeff() : 0.0;
  return (row * process).squaredNorm() + change * change / 3.0;
}

Widening widening(const Model& model, const Solution& fit, const Structure& structure,
                  const std::vector<TestedCandidate>& refused) {
  Widening out;
  out.process = response(fit, stack(fit.linear, structure.columns[0].cols(),
                                    [&](std::size_t i) { return structure.columns[i]; })) *
                structure.process.sizes.asDiagonal();
  out.refused.resize(out.process.rows(), 0);
  for (const TestedCandidate& each : refused) {
    if (each.refined.delta_bic > -model.gates.delta_bic || !each.is_possible()) continue;
    out.refused.conservativeResize(Eigen::NoChange, out.refused.cols() + 1);
    out.refused.rightCols(1) =
        response(fit, each.refined.columns * each.refined.projection.amplitudes);
  }
  return out;
}

}  // namespace slideway
