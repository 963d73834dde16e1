#include "slideway/identify/column_places.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

using Indices = std::vector<Eigen::Index>;

constexpr Eigen::Index kShared = -1;

/// The one profile each column acts in, or kShared.
Indices homes_of(const Linearisation& linear) {
  Indices out;
  for (Eigen::Index k = 0; k < linear.prior_rows.cols(); ++k) {
    Indices acts_in;
    for (Eigen::Index i = 0; i < std::ssize(linear.columns); ++i)
      if ((linear.columns[static_cast<std::size_t>(i)].col(k).array() != 0.0).any())
        acts_in.push_back(i);
    out.push_back(acts_in.size() == 1 ? acts_in.front() : kShared);
  }
  return out;
}

Indices columns_of(const Linearisation& linear, Eigen::Index prior) {
  Indices out;
  for (Eigen::Index k = 0; k < linear.prior_rows.cols(); ++k)
    if (linear.prior_rows(prior, k) != 0.0) out.push_back(k);
  return out;
}

/// What a prior ties to columns of elsewhere, or is a curve's, is shared.
void share_what_is_tied(const Linearisation& linear, Indices& homes) {
  const Eigen::Index plain = linear.prior_rows.rows() - linear.curve_rows;
  for (bool changed = true; changed;) {
    changed = false;
    for (Eigen::Index row = 0; row < linear.prior_rows.rows(); ++row) {
      const Indices columns = columns_of(linear, row);
      const auto is_elsewhere = [&](Eigen::Index k) {
        return row >= plain || homes[k] != homes[columns.front()];
      };
      if (std::ranges::none_of(columns, is_elsewhere)) continue;
      for (const Eigen::Index k : columns) {
        changed |= homes[k] != kShared;
        homes[k] = kShared;
      }
    }
  }
}

}  // namespace

ColumnPlaces::ColumnPlaces(const Linearisation& linear) : residuals(linear.residuals) {
  constexpr double kBound = 1e-12;  // of the largest: what less bounds is free
  const std::size_t count = linear.observations.size();
  Indices homes = homes_of(linear);
  share_what_is_tied(linear, homes);
  std::vector<Indices> alone(count), with_priors(count), own_priors(count);
  std::vector<bool> has_prior(homes.size(), false);
  for (Eigen::Index row = 0; row < linear.prior_rows.rows(); ++row) {
    const Indices columns = columns_of(linear, row);
    for (const Eigen::Index k : columns) has_prior[k] = true;
    const Eigen::Index home = columns.empty() ? kShared : homes[columns.front()];
    (home == kShared ? priors : own_priors[home]).push_back(row);
  }
  for (Eigen::Index k = 0; k < std::ssize(homes); ++k) {
    (homes[k] == kShared ? shared : own).push_back(k);
    if (homes[k] != kShared) (has_prior[k] ? with_priors : alone)[homes[k]].push_back(k);
  }
  for (std::size_t i = 0; i < count; ++i) {
    free.emplace_back(linear.columns[i](Eigen::all, alone[i]));
    bounded.emplace_back(residuals[i].size(), 0);
    if (with_priors[i].empty()) continue;
    const Eigen::MatrixXd columns = linear.columns[i](Eigen::all, with_priors[i]);
    const Eigen::MatrixXd rows = linear.prior_rows(own_priors[i], with_priors[i]);
    residuals[i] -= columns * least_squares(rows, linear.prior_residuals(own_priors[i])).values;
    const Eigen::VectorXd unit = rows.colwise().norm().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram_of(rows * unit.asDiagonal()));
    const Eigen::MatrixXd turned = columns * unit.asDiagonal() * eigen.eigenvectors();
    const Eigen::Index known = (eigen.eigenvalues().array() > kBound).count();
    append_columns(free.back(), turned.leftCols(turned.cols() - known));
    bounded.back() = turned.rightCols(known) *
                     eigen.eigenvalues().tail(known).cwiseSqrt().cwiseInverse().asDiagonal();
  }
}

}  // namespace slideway
