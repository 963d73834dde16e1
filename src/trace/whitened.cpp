#include "whitened.hpp"

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
  own_ = own_bases(linear.observations, noise_, undescribed_);
  Eigen::MatrixXd shared = stacked_model(linear);
  whiten(shared);
  shared_ = orthonormal(own_.beside(std::move(shared)));
  residual_ = stack(linear, 1, [&](std::size_t i) { return linear.residuals[i]; });
  residual_.tail(linear.prior_rows.rows()) = linear.prior_residuals;
  residual_ = outside(residual_);
}

Eigen::Index count_of(std::span<const RowRange> rows) {
  Eigen::Index out = 0;
  for (const RowRange& run : rows) out += run.count;
  return out;
}

template <typename Use>
void Whitened::for_each_in(std::span<const RowRange> rows, Use&& use) const {
  Eigen::Index at = 0;
  for (const RowRange& run : rows) {
    for (std::size_t i = 0; i < noise_.size(); ++i)
      if (first_[i] >= run.first && first_[i + 1] <= run.end()) use(i, at + first_[i] - run.first);
    at += run.count;
  }
}

void Whitened::whiten(std::span<const RowRange> rows, Eigen::Ref<Eigen::MatrixXd> columns) const {
  for_each_in(rows, [&](std::size_t i, Eigen::Index at) {
    noise_[i].whiten(columns.middleRows(at, count(i)));
  });
}

void Whitened::whiten(Eigen::Ref<Eigen::MatrixXd> stacked) const {
  for (std::size_t i = 0; i < noise_.size(); ++i)
    noise_[i].whiten(stacked.middleRows(first_[i], count(i)));
}

Eigen::MatrixXd Whitened::outside(Eigen::MatrixXd stacked) const {
  whiten(stacked);
  own_.take_out(stacked);
  project_out(shared_, stacked);
  return stacked;
}

Eigen::MatrixXd Whitened::inside(std::span<const RowRange> rows,
                                 const Eigen::MatrixXd& white) const {
  Eigen::Index next = shared_.cols(), size = next, from = 0;
  for_each_in(rows, [&](std::size_t i, Eigen::Index) { size += own_[i].cols(); });
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, white.cols());
  for (const RowRange& run : rows) {
    out.topRows(next) +=
        shared_.middleRows(run.first, run.count).transpose() * white.middleRows(from, run.count);
    from += run.count;
  }
  for_each_in(rows, [&](std::size_t i, Eigen::Index at) {
    out.middleRows(next, own_[i].cols()) = own_[i].transpose() * white.middleRows(at, count(i));
    next += own_[i].cols();
  });
  return out;
}

Whitened::Shown Whitened::shown_in(std::size_t profile, Eigen::MatrixXd columns) const {
  noise_[profile].whiten(columns);
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
