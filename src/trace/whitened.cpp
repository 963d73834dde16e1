#include "whitened.hpp"

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {

Eigen::MatrixXd model_span(const Linearisation& linear) {
  Eigen::Index nuisances = 0;
  for (const Observation* observation : linear.observations)
    nuisances += observation->nuisances.cols();
  const Eigen::Index shared = linear.prior_rows.cols();
  Eigen::Index next = 0;
  Eigen::MatrixXd out = stack(linear, nuisances + shared, [&](std::size_t i) {
    const Observation& observation = *linear.observations[i];
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(observation.values.size(), nuisances + shared);
    rows.middleCols(next, observation.nuisances.cols()) = observation.nuisances;
    rows.rightCols(shared) = linear.columns[i];
    next += observation.nuisances.cols();
    return rows;
  });
  out.bottomRightCorner(linear.prior_rows.rows(), shared) = linear.prior_rows;
  return out;
}

Whitened::Whitened(const Linearisation& linear, std::vector<Noise> noise,
                   Eigen::MatrixXd undescribed)
    : noise_(std::move(noise)), undescribed_(std::move(undescribed)) {
  for (const Observation* observation : linear.observations) {
    first_.push_back(values_);
    values_ += observation->values.size();
  }
  first_.push_back(values_);
  rows_ = values_ + linear.prior_rows.rows();
  if (undescribed_.cols() == 0) undescribed_.resize(rows_, 0);
  const Eigen::MatrixXd model = model_span(linear);
  Eigen::MatrixXd span(rows_, model.cols() + undescribed_.cols());
  span.leftCols(model.cols()) = model;
  span.rightCols(undescribed_.cols()) = undescribed_;
  whiten(span);
  basis_ = orthonormal(std::move(span));
  residual_ = stack(linear, 1, [&](std::size_t i) { return linear.residuals[i]; });
  residual_.tail(linear.prior_rows.rows()) = linear.prior_residuals;
  residual_ = outside(residual_);
}

void Whitened::whiten(Eigen::Ref<Eigen::MatrixXd> stacked) const {
  for (std::size_t i = 0; i < noise_.size(); ++i)
    noise_[i].whiten(stacked.middleRows(first_[i], count(i)));
}

Eigen::MatrixXd Whitened::outside(Eigen::MatrixXd stacked) const {
  whiten(stacked);
  stacked -= basis_ * (basis_.transpose() * stacked).eval();
  return stacked;
}

}  // namespace slideway
