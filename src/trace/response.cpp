#include "response.hpp"

#include <Eigen/QR>

#include "slideway/identify/linear_algebra.hpp"
#include "whitened.hpp"

namespace slideway {
namespace {

void whiten(const Solution& fit, Eigen::Ref<Eigen::MatrixXd> stacked) {
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const Eigen::Index count = fit.linear.observations[i]->values.size();
    fit.noise[i].whiten(stacked.middleRows(row, count));
    row += count;
  }
}

/// The model's columns, white and beside the levelling.
Eigen::MatrixXd design_of(const Solution& fit, const ProfileBases& levelling) {
  Eigen::MatrixXd design = stacked_model(fit.linear);
  whiten(fit, design);
  return levelling.beside(std::move(design));
}

}  // namespace

Eigen::MatrixXd response(const Solution& fit, Eigen::MatrixXd signals) {
  const ProfileBases levelling = own_bases(fit.linear.observations, fit.noise);
  whiten(fit, signals);
  levelling.take_out(signals);
  return least_squares(design_of(fit, levelling), signals).values;
}

RowResponse::RowResponse(const Solution& fit, const Eigen::MatrixXd& rows, const FreeValues& free)
    : fit_(fit) {
  const Eigen::MatrixXd design =
      design_of(fit, own_bases(fit.linear.observations, fit.noise, free));
  // The columns are beside the levelling, so their weights take it out of a signal as well.
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition(design);
  weights_ = decomposition.transpose().solve(rows.transpose());
}

Eigen::VectorXd RowResponse::to(Eigen::VectorXd signal) const {
  whiten(fit_, signal);
  return weights_.transpose() * signal;
}

}  // namespace slideway
