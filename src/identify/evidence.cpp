#include "slideway/identify/evidence.hpp"

#include <Eigen/Dense>

namespace slideway {
namespace {

/// d(amplitudes, shapes)/d(parameters); rows of very different units are brought to one size first.
Eigen::MatrixXd inverse(const Eigen::MatrixXd& jacobian) {
  const Eigen::VectorXd size =
      jacobian.rowwise().norm().unaryExpr([](double norm) { return norm > 0.0 ? norm : 1.0; });
  const Eigen::MatrixXd even = size.cwiseInverse().asDiagonal() * jacobian;
  return even.completeOrthogonalDecomposition().pseudoInverse() * size.cwiseInverse().asDiagonal();
}

/// Rows that are 0 along the null directions to the last digit: a parameter that nothing is known
/// of has a 0 then, not what rounding left, which others would take for knowledge.
void clear_along(const NullDirections& null, Eigen::Ref<Eigen::MatrixXd> rows) {
  for (const Eigen::Index own : null.own) rows.col(own).setZero();
  const Eigen::MatrixXd owed = rows * null.parameters;
  for (std::size_t d = 0; d < null.own.size(); ++d) rows.col(null.own[d]) = -owed.col(d);
}

}  // namespace

Evidence evidence(const Model& model, const Solution& fit) {
  Linearisation data = fit.linear;
  data.prior_rows.resize(0, model.amplitudes() + model.shapes());
  data.prior_residuals.resize(0);
  const bool has_priors = fit.linear.prior_rows.rows() > 0;
  const Compressed compressed = compress(data, fit.noise);
  const Eigen::MatrixXd to_amplitudes = inverse(fit.parameters.jacobian);
  const Rank rank =
      has_priors ? analyse_rank(compressed.triangle, compressed.scale, model.gates.rank_tolerance)
                 : fit.rank;
  const Uncertainty uncertainty =
      has_priors ? assess(data, compressed, fit.noise, rank.basis, fit.uncertainty.inflation)
                 : fit.uncertainty;

  // w = image * (amplitudes, shapes) is determined with that covariance; what is left of it at the
  // estimate is what the priors pulled.
  const Eigen::MatrixXd image = rank.basis.transpose() * compressed.triangle.transpose();
  const Eigen::LLT<Eigen::MatrixXd> root(uncertainty.inflation * uncertainty.covariance);
  Evidence out;
  out.parameters = model.parameter_names();
  for (const ModelTerm& term : model.terms)
    for (const Parameter& parameter : term.effect->parameters())
      out.units.push_back(parameter.unit);
  if (image.rows() == 0 || root.info() != Eigen::Success || fit.estimate.curve) return out;
  Eigen::MatrixXd system(image.rows(), model.parameters() + 1);
  auto rows = system.leftCols(model.parameters());
  rows = root.matrixL().solve(image * compressed.triangle * to_amplitudes);
  if (has_priors)
    clear_along(null_directions(model, rank, fit.parameters.jacobian,
                                (compressed.scale.asDiagonal() * to_amplitudes)
                                    .colwise()
                                    .norm()
                                    .transpose()
                                    .unaryExpr([](double s) { return s > 0.0 ? s : 1.0; })),
                rows);
  else
    clear_along(fit.null, rows);
  system.rightCols(1) = rows * fit.parameters.values;
  if (has_priors)
    system.rightCols(1) += root.matrixL().solve(
        rank.basis.transpose() * (compressed.triangle.transpose() * compressed.target));

  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(system.leftCols(model.parameters()));
  system.rightCols(1).applyOnTheLeft(qr.householderQ().adjoint());
  rows = qr.matrixQR().triangularView<Eigen::Upper>();
  for (Eigen::Index i = 0; i < system.rows(); ++i) {
    out.rows.emplace_back(rows.cols());
    for (Eigen::Index j = 0; j < rows.cols(); ++j) out.rows.back()[j] = rows(i, j);
    out.values.push_back(system(i, rows.cols()));
  }
  return out;
}

}  // namespace slideway
