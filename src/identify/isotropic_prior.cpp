#include "slideway/identify/isotropic_prior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace slideway {
namespace {

constexpr double kLeastPivot = 0.5;  // 1 but for rounding, as B is positive semidefinite

}  // namespace

/// I + v B = L D Lᵀ with the targets eliminated: D and L⁻¹ (q, Sᵀ). With R = (I + v B)⁻¹,
///   (I + v A)⁻¹ = R + v R Sᵀ K⁻¹ S R,  K = I - v S R Sᵀ,  det (I + v A) = det D det K.
struct IsotropicPrior::Elimination {
  Eigen::ArrayXd pivots, factors;
  Eigen::MatrixXd targets;
  Eigen::MatrixXd inner;          // (q, Sᵀ)ᵀ R (q, Sᵀ)
  Eigen::LLT<Eigen::MatrixXd> k;  // K

  [[nodiscard]] auto coupling() const { return inner.col(0).tail(inner.rows() - 1); }
};

IsotropicPrior::IsotropicPrior(const Eigen::MatrixXd& information, const Eigen::VectorXd& products)
    : IsotropicPrior({information}, Eigen::MatrixXd(0, products.size()), products) {}

IsotropicPrior::IsotropicPrior(const std::vector<Eigen::MatrixXd>& blocks,
                               const Eigen::MatrixXd& shared, const Eigen::VectorXd& products)
    : diagonal_(products.size()),
      beside_(Eigen::ArrayXd::Zero(products.size())),
      targets_(products.size(), 1 + shared.rows()) {
  targets_ << products, shared.transpose();
  Eigen::Index first = 0;
  for (const Eigen::MatrixXd& block : blocks) {
    const Eigen::Tridiagonalization<Eigen::MatrixXd> reduced(block);
    const Eigen::Index size = block.rows();
    axes_.emplace_back(reduced.matrixQ());
    diagonal_.segment(first, size) = reduced.diagonal();
    beside_.segment(first, size - 1) = reduced.subDiagonal();
    targets_.middleRows(first, size) =
        (axes_.back().transpose() * targets_.middleRows(first, size)).eval();
    first += size;
  }
}

IsotropicPrior::Elimination IsotropicPrior::eliminated(double variance) const {
  Elimination out{1.0 + variance * diagonal_, variance * beside_, targets_, {}, {}};
  for (Eigen::Index i = 1; i < out.pivots.size(); ++i) {
    const double off = out.factors[i - 1];
    if (off == 0.0) continue;  // another block begins
    out.factors[i - 1] /= out.pivots[i - 1];
    out.pivots[i] -= out.factors[i - 1] * off;
    out.targets.row(i) -= out.factors[i - 1] * out.targets.row(i - 1);
  }
  out.inner = out.targets.transpose() * out.pivots.inverse().matrix().asDiagonal() * out.targets;
  const Eigen::Index shared = targets_.cols() - 1;
  out.k.compute(Eigen::MatrixXd::Identity(shared, shared) -
                variance * out.inner.bottomRightCorner(shared, shared));
  return out;
}

double IsotropicPrior::log_evidence(double variance) const {
  const Elimination done = eliminated(variance);
  if (done.pivots.minCoeff() < kLeastPivot || done.k.info() != Eigen::Success) return -INFINITY;
  const Eigen::VectorXd coupling = done.k.matrixL().solve(done.coupling());
  return 0.5 * (variance * (done.inner(0, 0) + variance * coupling.squaredNorm()) -
                done.pivots.log().sum()) -
         done.k.matrixLLT().diagonal().array().log().sum();
}

Eigen::VectorXd IsotropicPrior::mean(double variance) const {
  const Elimination done = eliminated(variance);
  const Eigen::Index shared = targets_.cols() - 1;
  Eigen::VectorXd out = done.targets.col(0) +
                        variance * done.targets.rightCols(shared) * done.k.solve(done.coupling());
  out.array() /= done.pivots;
  for (Eigen::Index i = out.size() - 1; i-- > 0;) out[i] -= done.factors[i] * out[i + 1];
  Eigen::Index first = 0;
  for (const Eigen::MatrixXd& axes : axes_) {
    out.segment(first, axes.rows()) = (axes * out.segment(first, axes.rows())).eval();
    first += axes.rows();
  }
  return variance * out;
}

}  // namespace slideway
