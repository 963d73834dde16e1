#pragma once

#include <Eigen/Core>
#include <vector>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// All fitted low bands under one another, and the priors below them, made white: what the search
/// for a missing effect looks at.
///
/// Rows are low-band values divided by their noise (generalised least squares); the span of the
/// model's columns, of its shapes' derivatives and of the nuisances is taken out of the residual,
/// so that only what the model cannot make is left.
class Whitened {
 public:
  /// @param linear  the model at its fit
  /// @param noise   per fitted observation
  /// @param undescribed  stacked columns that are left free beside the model's
  ///                     (undescribed_columns()); 0 by 0: none
  Whitened(const Linearisation& linear, std::vector<Noise> noise,
           Eigen::MatrixXd undescribed = Eigen::MatrixXd(0, 0));

  [[nodiscard]] Eigen::Index rows() const { return rows_; }
  /// Values without the priors.
  [[nodiscard]] Eigen::Index values() const { return values_; }
  [[nodiscard]] std::size_t observations() const { return noise_.size(); }
  [[nodiscard]] Eigen::Index first_row(std::size_t observation) const {
    return first_[observation];
  }
  [[nodiscard]] Eigen::Index count(std::size_t observation) const {
    return first_[observation + 1] - first_[observation];
  }
  [[nodiscard]] const std::vector<Noise>& noise() const { return noise_; }

  /// Stacked low-band columns (rows() of them, zero in the rows of priors) made white, in place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> stacked) const;

  /// The same, then without what the model and the nuisances span.
  [[nodiscard]] Eigen::MatrixXd outside(Eigen::MatrixXd stacked) const;

  /// Orthonormal, rows() by k: what the model and the nuisances span.
  [[nodiscard]] const Eigen::MatrixXd& basis() const { return basis_; }

  /// Stacked columns that are left free beside the model.
  [[nodiscard]] const Eigen::MatrixXd& undescribed() const { return undescribed_; }

  /// White residual outside that span.
  [[nodiscard]] const Eigen::VectorXd& residual() const { return residual_; }

 private:
  std::vector<Noise> noise_;
  Eigen::MatrixXd undescribed_;
  std::vector<Eigen::Index> first_;
  Eigen::Index values_ = 0;
  Eigen::Index rows_ = 0;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd residual_;
};

/// Rows of observations under one another, with rows of zeros for the priors below: the layout of
/// Whitened. `of(i)` gives the rows of observation i.
template <typename Of>
Eigen::MatrixXd stack(const std::vector<const Observation*>& observations, Eigen::Index prior_rows,
                      Eigen::Index columns, Of&& of) {
  Eigen::Index rows = prior_rows;
  for (const Observation* observation : observations) rows += observation->values.size();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, columns);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Eigen::Index count = observations[i]->values.size();
    out.middleRows(row, count) = of(i);
    row += count;
  }
  return out;
}

template <typename Of>
Eigen::MatrixXd stack(const Linearisation& linear, Eigen::Index columns, Of&& of) {
  return stack(linear.observations, linear.prior_rows.rows(), columns, of);
}

/// What the model makes, stacked: nuisances of each profile in columns of their own, then
/// amplitudes and shapes.
Eigen::MatrixXd model_span(const Linearisation& linear);

}  // namespace slideway
