#include "restricted_likelihood.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace slideway {

Autoregression correlation_of(const Eigen::VectorXd& parameters) {
  std::vector<double> partial(parameters.size() - 1);
  for (std::size_t j = 0; j < partial.size(); ++j)
    partial[j] = std::tanh(std::clamp(parameters[j], -kLargestAtanh, kLargestAtanh));
  return Autoregression(partial);
}

WhitenedProducts::WhitenedProducts(const ColumnParts& columns, int max_order)
    : head_(rows_of(columns, 0, max_order)) {
  const Eigen::MatrixXd tail = rows_of(columns, columns.front().rows() - max_order, max_order);
  products_.assign(max_order + 1, std::vector<Eigen::MatrixXd>(max_order + 1));
  products_[0] = lagged_grams(columns, max_order);
  for (int a = 1; a <= max_order; ++a)
    for (int b = a; b <= max_order; ++b)
      products_[a][b] = products_[a - 1][b - 1] +
                        head_.row(max_order - a).transpose() * head_.row(max_order - b) -
                        tail.row(max_order - a).transpose() * tail.row(max_order - b);
  for (int a = 0; a <= max_order; ++a)  // they only come in pairs
    for (int b = a + 1; b <= max_order; ++b) products_[a][b] += products_[a][b].transpose().eval();
}

Eigen::MatrixXd WhitenedProducts::under(const Autoregression& noise) const {
  const int max_order = static_cast<int>(head_.rows());
  const int p = noise.order();
  std::vector<double> filter(p + 1, 1.0);
  for (int j = 1; j <= p; ++j) filter[j] = -noise.predictor(p)[j - 1];
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(head_.cols(), head_.cols());
  for (int a = 0; a <= p; ++a) {
    out += filter[a] * filter[a] * products_[a][a];
    for (int b = a + 1; b <= p; ++b) out += filter[a] * filter[b] * products_[a][b];
  }
  for (int t = 0; t < max_order; ++t) {
    const int m = std::min(t, p);
    Eigen::RowVectorXd row = head_.row(t);
    for (int j = 1; j <= m; ++j) row -= noise.predictor(m)[j - 1] * head_.row(t - j);
    out += row.transpose() * row / noise.relative_variance(m);
  }
  return out;
}

RestrictedLikelihood::RestrictedLikelihood(const LinearProfile& profile, int max_order)
    : n_(profile.residual.size()),
      m_(profile.nuisances.cols()),
      r_(profile.columns.cols()),
      products_({profile.nuisances, profile.columns, profile.residual}, max_order) {}

Eigen::MatrixXd RestrictedLikelihood::information(const Eigen::VectorXd& parameters,
                                                  double* cost) const {
  const Autoregression noise = correlation_of(parameters);
  const double log_variance = 2.0 * parameters[parameters.size() - 1];
  Eigen::MatrixXd gram = products_.under(noise) * std::exp(-log_variance);
  double own = static_cast<double>(n_) * log_variance + noise.log_determinant(n_);
  if (m_ > 0) {
    const Eigen::LLT<Eigen::MatrixXd> nuisance(gram.topLeftCorner(m_, m_));
    if (nuisance.info() != Eigen::Success) own = INFINITY;
    own += 2.0 * nuisance.matrixLLT().diagonal().array().log().sum();
    const Eigen::MatrixXd cross = nuisance.matrixL().solve(gram.topRightCorner(m_, r_ + 1));
    gram.bottomRightCorner(r_ + 1, r_ + 1) -= cross.transpose() * cross;
  }
  if (cost) *cost = own;
  return gram.bottomRightCorner(r_ + 1, r_ + 1);
}

double RestrictedLikelihood::operator()(const Eigen::VectorXd& parameters,
                                        const Eigen::MatrixXd& rest) const {
  double own = 0.0;
  const Eigen::LLT<Eigen::MatrixXd> joint(information(parameters, &own) + rest);
  if (joint.info() != Eigen::Success || !std::isfinite(own)) return INFINITY;
  const Eigen::VectorXd diagonal = joint.matrixLLT().diagonal();
  return own + 2.0 * diagonal.head(r_).array().log().sum() + diagonal[r_] * diagonal[r_];
}

}  // namespace slideway
