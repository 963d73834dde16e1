#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "slideway/identify/fit.hpp"
#include "slideway/identify/profile_bases.hpp"

namespace slideway {

/// RowRange of stacked columns: of whole profiles, one after another.
struct RowRange {
  Eigen::Index first = 0, count = 0;

  [[nodiscard]] Eigen::Index end() const { return first + count; }
};

/// All fitted low bands under one another, and the priors below them, made white: what the search
/// for a missing effect looks at.
///
/// RowRange are low-band values divided by their noise (generalised least squares); the span of the
/// model's columns, of its shapes' derivatives and of the nuisances is taken out of the residual,
/// so that only what the model cannot make is left.
class Whitened {
 public:
  /// @param linear  the model at its fit
  /// @param noise   per fitted observation
  /// @param undescribed  values that are left free beside the model (undescribed_beside())
  Whitened(const Linearisation& linear, std::vector<Noise> noise, FreeValues undescribed = {});

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
  /// The same with the errors that priors leave what acts in one profile alone.
  [[nodiscard]] const std::vector<Noise>& total_noise() const { return total_; }

  /// The same noises, their alternatives weighed anew.
  void set_alternatives(std::vector<Noise> noise) { noise_ = std::move(noise); }

  /// Stacked low-band columns (rows() of them, zero in the rows of priors) made white, in place.
  void whiten(Eigen::Ref<Eigen::MatrixXd> stacked) const;

  /// The same, then without what the model and the nuisances span.
  [[nodiscard]] Eigen::MatrixXd outside(Eigen::MatrixXd stacked) const;

  /// White columns in some rows, without what the model and the nuisances span there.
  /// @param rows  rising, with those of the priors; as many as `white` has
  [[nodiscard]] Eigen::MatrixXd outside_in(const std::vector<Eigen::Index>& rows,
                                           Eigen::MatrixXd white) const;

  /// Columns of one profile, white, and their products with bases of what is free.
  struct Seen {
    Eigen::MatrixXd own;     // in that profile alone
    Eigen::MatrixXd shared;  // of profiles together
    Eigen::MatrixXd white;
  };
  [[nodiscard]] Seen seen_in(std::size_t profile, Eigen::MatrixXd columns) const;

  /// What columns of one profile show beside its nuisances. Over profiles, with sums of each: the
  /// Gram matrix of the columns outside the model's span is gram - sharedᵀ shared.
  struct Shown {
    Eigen::MatrixXd gram;      // of the white columns
    Eigen::MatrixXd shared;    // of what else is free with them
    Eigen::VectorXd products;  // with the residual
  };
  [[nodiscard]] Shown shown_in(std::size_t profile, Eigen::MatrixXd columns) const;

  /// Values that are left free beside the model, by profile.
  [[nodiscard]] const FreeValues& undescribed() const { return undescribed_; }

  /// White residual outside that span.
  [[nodiscard]] const Eigen::VectorXd& residual() const { return residual_; }

 private:
  std::vector<Noise> noise_;
  std::vector<Noise> total_;
  FreeValues undescribed_;
  std::vector<Eigen::Index> first_;
  Eigen::Index values_ = 0;
  Eigen::Index rows_ = 0;
  ProfileBases own_;        // of what is free in one profile alone
  Eigen::MatrixXd shared_;  // of what else is free, orthogonal to those
  Eigen::VectorXd residual_;
};

/// RowRange of observations under one another, with rows of zeros for the priors below: the layout
/// of Whitened. `of(i)` gives the rows of observation i.
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

/// Least squares of stacked targets by stacked columns, the nuisances of each profile left free:
/// they are taken out of both first (Frisch, Waugh and Lovell). Of the columns, one column each
/// target.
Eigen::MatrixXd beside_levelling(const Linearisation& linear, Eigen::MatrixXd columns,
                                 Eigen::MatrixXd targets);

/// Columns of the model's amplitudes and shapes, stacked, with the rows of the priors.
Eigen::MatrixXd stacked_model(const Linearisation& linear);

/// What the model makes, stacked: nuisances of each profile in columns of their own, then
/// amplitudes and shapes.
Eigen::MatrixXd model_span(const Linearisation& linear);

}  // namespace slideway
