#include "whitened.hpp"

#include "slideway/identify/column_places.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {

Eigen::MatrixXd model_span(const Linearisation& linear) {
  Eigen::Index count = 0;
  for (const Observation* observation : linear.observations) count += observation->nuisances.cols();
  const Eigen::MatrixXd model = stacked_model(linear);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(model.rows(), count + model.cols());
  out.rightCols(model.cols()) = model;
  Eigen::Index row = 0, column = 0;
  for (const Observation* observation : linear.observations) {
    const Eigen::MatrixXd& own = observation->nuisances;
    out.block(row, column, own.rows(), own.cols()) = own;
    row += own.rows();
    column += own.cols();
  }
  return out;
}

Eigen::MatrixXd beside_levelling(const Linearisation& linear, Eigen::MatrixXd columns,
                                 Eigen::MatrixXd targets) {
  ProfileBases nuisances;
  for (const Observation* observation : linear.observations) nuisances.add(observation->nuisances);
  columns = nuisances.beside(std::move(columns));
  nuisances.take_out(targets);
  return least_squares(columns, targets).values;
}

/// Amplitudes' and shapes' columns, stacked, with the priors' rows.
Eigen::MatrixXd stacked_model(const Linearisation& linear) {
  Eigen::MatrixXd out =
      stack(linear, linear.prior_rows.cols(), [&](std::size_t i) { return linear.columns[i]; });
  out.bottomRows(linear.prior_rows.rows()) = linear.prior_rows;
  return out;
}

Whitened::Whitened(const Linearisation& linear, std::vector<Noise> noise, FreeValues undescribed)
    : noise_(std::move(noise)), undescribed_(std::move(undescribed)) {
  for (const Observation* observation : linear.observations) {
    first_.push_back(values_);
    values_ += observation->values.size();
  }
  first_.push_back(values_);
  rows_ = values_ + linear.prior_rows.rows();
  undescribed_.resize(noise_.size());
  const ColumnPlaces places(linear);
  total_ = noise_;
  for (std::size_t i = 0; i < total_.size(); ++i)
    if (places.bounded[i].cols() > 0) total_[i].add_known(places.bounded[i]);
  own_ = own_bases(linear.observations, total_, undescribed_, places.free);
  Eigen::MatrixXd shared = stacked_model(linear)(Eigen::all, places.shared);
  whiten(shared);
  shared_ = orthonormal(own_.beside(std::move(shared)));
  residual_ = stack(linear, 1, [&](std::size_t i) { return places.residuals[i]; });
  for (const Eigen::Index prior : places.priors)
    residual_[values_ + prior] = linear.prior_residuals[prior];
  residual_ = outside(residual_);
}

void Whitened::whiten(Eigen::Ref<Eigen::MatrixXd> stacked) const {
  for (std::size_t i = 0; i < total_.size(); ++i)
    total_[i].whiten(stacked.middleRows(first_[i], count(i)));
}

Eigen::MatrixXd Whitened::outside(Eigen::MatrixXd stacked) const {
  whiten(stacked);
  own_.take_out(stacked);
  project_out(shared_, stacked);
  return stacked;
}

Whitened::Seen Whitened::seen_in(std::size_t profile, Eigen::MatrixXd columns) const {
  Seen out;
  out.white = std::move(columns);
  total_[profile].whiten(out.white);
  out.own = own_[profile].transpose() * out.white;
  out.shared = shared_.middleRows(first_[profile], count(profile)).transpose() * out.white;
  return out;
}

Whitened::Shown Whitened::shown_in(std::size_t profile, Eigen::MatrixXd columns) const {
  total_[profile].whiten(columns);
  own_.take_out_of(profile, columns);
  const Eigen::Index first = first_[profile], rows = count(profile);
  Shown out;
  out.gram = gram_of(columns);
  out.shared = shared_.middleRows(first, rows).transpose() * columns;
  out.products = columns.transpose() * residual_.segment(first, rows);
  return out;
}

Eigen::MatrixXd Whitened::outside_in(const std::vector<Eigen::Index>& rows,
                                     Eigen::MatrixXd white) const {
  const ProfileBases own = own_.in(rows);
  const Eigen::MatrixXd shared = orthonormal(own.beside(shared_(rows, Eigen::all)));
  own.take_out(white);
  project_out(shared, white);
  return white;
}

}  // namespace slideway
