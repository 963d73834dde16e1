#include "paper_data.hpp"

#include <Eigen/Dense>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

/// Part of a column's square below which what is left of it is rounding, or the model's own: as in
/// the search.
constexpr double kMadeByOthers = 1e-9;
constexpr double kSwallowed = 1e-10;  // of a column's norm

Eigen::VectorXd inverse_roots(const Eigen::VectorXd& squares) {
  return squares.unaryExpr([](double s) { return s > 0.0 ? 1.0 / std::sqrt(s) : 0.0; });
}

}  // namespace

PaperProfile::PaperProfile(const Observation& observation, const Noise& noise,
                           const Eigen::MatrixXd& columns, Eigen::MatrixXd suspects)
    : values(observation.values.size()) {
  const Eigen::Index free = observation.nuisances.cols();
  Eigen::MatrixXd rows(values, free + columns.cols());
  rows << observation.nuisances, columns;
  noise.whiten(rows);
  noise.whiten(suspects);
  squares = suspects.colwise().squaredNorm().transpose();
  scale = rows.rightCols(columns.cols()).colwise().squaredNorm().transpose();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  suspects.applyOnTheLeft(qr.householderQ().adjoint());
  const Eigen::Index top = std::min(values, rows.cols()),
                     own = std::max<Eigen::Index>(top - free, 0);
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(top).triangularView<Eigen::Upper>();
  model = triangle.bottomRightCorner(own, columns.cols());
  inside = suspects.middleRows(top - own, own);
  outside = suspects.bottomRows(values - top);
}

PaperData::PaperData(std::vector<const PaperProfile*> profiles, const Eigen::MatrixXd& prior_rows)
    : profiles_(std::move(profiles)), squares_(Eigen::VectorXd::Zero(profiles_[0]->inside.cols())) {
  Eigen::Index rows = prior_rows.rows(), row = 0;
  for (const PaperProfile* profile : profiles_) rows += profile->model.rows();
  Eigen::MatrixXd model(rows, prior_rows.cols());
  inside_ = Eigen::MatrixXd::Zero(rows, squares_.size());
  Eigen::VectorXd scale = prior_rows.colwise().squaredNorm().transpose();
  for (const PaperProfile* profile : profiles_) {
    const Eigen::Index count = profile->model.rows();
    model.middleRows(row, count) = profile->model;
    inside_.middleRows(row, count) = profile->inside;
    row += count;
    scale += profile->scale;
    squares_ += profile->squares;
    values_ += profile->values;
  }
  model.bottomRows(prior_rows.rows()) = prior_rows;
  for (Eigen::Index j = 0; j < model.cols(); ++j)
    if (model.col(j).norm() <= kSwallowed * std::sqrt(scale[j])) model.col(j).setZero();
  const Eigen::MatrixXd basis = orthonormal(std::move(model));
  project_out(basis, inside_);
}

Eigen::MatrixXd PaperData::products(const std::vector<Eigen::Index>& columns,
                                    const std::vector<Eigen::Index>& others) const {
  const auto of = [&](const Eigen::MatrixXd& rows) -> Eigen::MatrixXd {
    return rows(Eigen::all, columns).eval().transpose() * rows(Eigen::all, others).eval();
  };
  Eigen::MatrixXd out = of(inside_);
  for (const PaperProfile* profile : profiles_) out += of(profile->outside);
  return out;
}

Eigen::MatrixXd PaperData::left(const std::vector<Eigen::Index>& columns,
                                const std::vector<Eigen::Index>& beside) const {
  Eigen::MatrixXd out = products(columns, columns);
  if (!beside.empty()) {
    const Eigen::VectorXd unit = inverse_roots(squares_(beside));
    const Eigen::MatrixXd cross = unit.asDiagonal() * products(beside, columns);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        unit.asDiagonal() * products(beside, beside) * unit.asDiagonal());
    const Eigen::Index known = (eigen.eigenvalues().array() > kMadeByOthers).count();
    const Eigen::MatrixXd taken =
        eigen.eigenvalues().tail(known).cwiseSqrt().cwiseInverse().asDiagonal() *
        eigen.eigenvectors().rightCols(known).transpose() * cross;
    out -= taken.transpose() * taken;
  }
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    if (out(at, at) > kMadeByOthers * squares_[columns[j]]) continue;
    out.row(at).setZero();
    out.col(at).setZero();
  }
  return out;
}

Eigen::Index PaperData::rank(const std::vector<Eigen::Index>& columns) const {
  const Eigen::VectorXd unit = inverse_roots(squares_(columns));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      unit.asDiagonal() * products(columns, columns) * unit.asDiagonal(), Eigen::EigenvaluesOnly);
  return (eigen.eigenvalues().array() > kMadeByOthers).count();
}

}  // namespace slideway
