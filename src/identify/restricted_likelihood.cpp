#include "restricted_likelihood.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

constexpr double kLeastFreedom = 0.5;  // below: rounding

/// ln σ where ν - rss / σ² + (ln σ - mean) / likeness² = 0, by Newton's method: the left side
/// rises.
double settled(double log_size, double freedom, double square, double mean, double likeness) {
  const double tightness = 1.0 / (likeness * likeness);
  log_size = 0.5 * std::log(square / freedom);
  for (int step = 0; step < 50; ++step) {
    const double in_units = square * std::exp(-2.0 * log_size);
    const double change =
        (freedom - in_units + tightness * (log_size - mean)) / (2.0 * in_units + tightness);
    log_size -= std::clamp(change, -1.0, 1.0);
    if (std::abs(change) < 1e-12) break;
  }
  return log_size;
}

Eigen::MatrixXd joint_information(std::span<const ProfileInformation> profiles,
                                  const Eigen::MatrixXd& rest, const Eigen::VectorXd& log_sizes) {
  Eigen::MatrixXd joint = rest;
  for (std::size_t i = 0; i < profiles.size(); ++i)
    joint += profiles[i].of_shared(log_sizes[static_cast<Eigen::Index>(i)]);
  return joint;
}

MixtureFactor factor_of(const LinearProfile& profile, const ExponentialMixture& covariance) {
  return profile.stations.empty() ? MixtureFactor(covariance, profile.residual.size())
                                  : MixtureFactor(covariance, profile.stations);
}

/// ln det V and r' V^-1 r.
struct WhiteResidual {
  double log_determinant = 0.0, square = 0.0;

  WhiteResidual(const LinearProfile& profile, const ExponentialMixture& covariance) {
    const MixtureFactor factor = factor_of(profile, covariance);
    Eigen::MatrixXd white = profile.residual;
    factor.whiten(white);
    log_determinant = factor.log_determinant();
    square = white.squaredNorm();
  }
};

/// Neighbours among the values of a profile.
std::vector<Run> runs_of(const LinearProfile& profile) {
  const Eigen::Index n = profile.residual.size();
  if (profile.stations.empty()) return {{0, n}};
  std::vector<Run> out{{0, 1}};
  for (Eigen::Index i = 1; i < n; ++i)
    if (profile.stations[i] - profile.stations[i - 1] == 1.0)
      ++out.back().second;
    else
      out.emplace_back(i, 1);
  return out;
}

/// Whether means of 2^octaves neighbours hold nearly all values, and nearly all of every column.
bool are_slow(const LinearProfile& profile, const std::vector<Run>& runs, int octaves) {
  constexpr double kHeld = 0.9;    // of a column's square: what it says of a noise hardly changes
  constexpr double kWhole = 0.99;  // of the values
  const double block = std::exp2(octaves);
  double whole = 0.0;
  for (const auto& [first, count] : runs) whole += block * static_cast<double>(count >> octaves);
  if (whole < kWhole * static_cast<double>(profile.residual.size())) return false;
  const auto hold = [&](const Eigen::MatrixXd& columns) {
    const Eigen::MatrixXd means = block_means(columns, runs, octaves);
    return (block * means.colwise().squaredNorm().array() >=
            kHeld * columns.colwise().squaredNorm().array())
        .all();
  };
  return hold(profile.columns) && hold(profile.bounded);
}

LinearProfile in_means(const LinearProfile& profile, const std::vector<Run>& runs, int octaves) {
  LinearProfile out;
  out.nuisances = orthonormal(block_means(profile.nuisances, runs, octaves));
  out.columns = block_means(profile.columns, runs, octaves);
  out.bounded = block_means(profile.bounded, runs, octaves);
  out.residual = block_means(profile.residual, runs, octaves);
  for (const auto& [first, count] : runs)
    for (Eigen::Index i = 0; runs.size() > 1 && i < count >> octaves; ++i)
      out.stations.push_back(std::ldexp(profile.stations[first], -octaves) +
                             static_cast<double>(i));
  return out;
}

}  // namespace

ProfileInformation::ProfileInformation(const LinearProfile& profile,
                                       const ExponentialMixture& covariance) {
  const Eigen::Index n = profile.residual.size(), m = profile.nuisances.cols();
  const Eigen::Index r = profile.columns.cols(), q = profile.bounded.cols();
  const MixtureFactor factor = factor_of(profile, covariance);
  Eigen::MatrixXd rows(n, m + q + r + 1);
  rows.leftCols(m) = profile.nuisances;
  if (q > 0) rows.middleCols(m, q) = profile.bounded;
  rows.rightCols(r + 1) << profile.columns, profile.residual;
  factor.whiten(rows);
  Eigen::MatrixXd own = gram_of(rows);
  freedom = static_cast<double>(n - m);
  log_determinants = factor.log_determinant();
  if (m > 0) {
    const Eigen::LLT<Eigen::MatrixXd> nuisance(own.topLeftCorner(m, m));
    if (nuisance.info() != Eigen::Success) log_determinants = INFINITY;
    log_determinants += 2.0 * nuisance.matrixLLT().diagonal().array().log().sum();
    const Eigen::MatrixXd cross = nuisance.matrixL().solve(own.topRightCorner(m, q + r + 1));
    own = (own.bottomRightCorner(q + r + 1, q + r + 1) - cross.transpose() * cross).eval();
  }
  gram_ = own.bottomRightCorner(r + 1, r + 1);
  if (q == 0) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> turned(own.topLeftCorner(q, q));
  bounded_ = turned.eigenvalues().array().max(0.0);
  between_ = turned.eigenvectors().transpose() * own.topRightCorner(q, r + 1);
}

void ProfileInformation::add(double log_determinant, double square, double values) {
  log_determinants += log_determinant;
  gram_(gram_.rows() - 1, gram_.cols() - 1) += square;
  freedom += values;
}

Eigen::MatrixXd ProfileInformation::of_shared(double log_size) const {
  const double square = std::exp(2.0 * log_size);
  Eigen::MatrixXd out = gram_ / square;
  if (bounded_.size() > 0)
    out.noalias() -= between_.transpose() *
                     (square * (square + bounded_)).inverse().matrix().asDiagonal() * between_;
  return out;
}

Eigen::MatrixXd ProfileInformation::of_rest(double log_size) const {
  const double square = std::exp(2.0 * log_size);
  Eigen::MatrixXd out = gram_;
  if (bounded_.size() > 0)
    out.noalias() -=
        between_.transpose() *
        ((2.0 * square + bounded_) / (square + bounded_).square()).matrix().asDiagonal() * between_;
  return out;
}

double ProfileInformation::taken_by_bounded(double log_size) const {
  return (bounded_ / (std::exp(2.0 * log_size) + bounded_)).sum();
}

double ProfileInformation::log_determinant_of_bounded(double log_size) const {
  return (bounded_ * std::exp(-2.0 * log_size)).log1p().sum();
}

ProfileLikelihood::ProfileLikelihood(const LinearProfile& profile) : profile_(&profile) {
  constexpr double kLong = 4096.0;   // values: fewer are quick enough
  constexpr double kFewest = 512.0;  // means: of noise slower than 256 cycles, all is kept
  const auto n = static_cast<double>(profile.residual.size());
  const auto free = static_cast<double>(profile.nuisances.cols() + profile.columns.cols() +
                                        profile.bounded.cols());
  if (n < kLong) return;
  const std::vector<Run> runs = runs_of(profile);
  auto octaves = static_cast<int>(std::log2(n / std::max(kFewest, 4.0 * free)));
  while (octaves > 0 && !are_slow(profile, runs, octaves)) --octaves;
  if (octaves > 0)
    thinned_ = Thinned{in_means(profile, runs, octaves),
                       OctavePowers(profile.residual, runs, octaves), std::exp2(octaves)};
}

ProfileInformation ProfileLikelihood::under(const ExponentialMixture& covariance) const {
  if (!thinned_) return {*profile_, covariance};
  const LinearProfile& means = thinned_->means;
  const ExponentialMixture of_means = covariance.of_means(thinned_->block);
  ProfileInformation out(means, of_means);
  const WhiteResidual whole(*profile_, covariance), part(means, of_means);
  out.add(whole.log_determinant - part.log_determinant, whole.square - part.square,
          static_cast<double>(profile_->residual.size() - means.residual.size()));
  return out;
}

ProfileInformation ProfileLikelihood::nearly_under(const ExponentialMixture& covariance) const {
  if (!thinned_) return {*profile_, covariance};
  ProfileInformation out(thinned_->means, covariance.of_means(thinned_->block));
  const OctavePowers::Fit fit = thinned_->faster.under(covariance);
  out.add(fit.log_determinant, fit.square, thinned_->faster.count());
  return out;
}

double restricted_cost(std::span<const ProfileInformation> profiles, const Eigen::MatrixXd& rest,
                       const Eigen::VectorXd& log_sizes) {
  double cost = 0.0;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const double log_size = log_sizes[static_cast<Eigen::Index>(i)];
    cost += profiles[i].log_determinants + 2.0 * profiles[i].freedom * log_size +
            profiles[i].log_determinant_of_bounded(log_size);
  }
  const Eigen::LLT<Eigen::MatrixXd> joint(joint_information(profiles, rest, log_sizes));
  if (joint.info() != Eigen::Success || !std::isfinite(cost)) return INFINITY;
  const Eigen::Index r = rest.cols() - 1;
  const Eigen::VectorXd diagonal = joint.matrixLLT().diagonal();
  return cost + 2.0 * diagonal.head(r).array().log().sum() + diagonal[r] * diagonal[r];
}

FittedSizes fit_sizes(std::span<const ProfileInformation> profiles, const Eigen::MatrixXd& rest,
                      double likeness, Eigen::VectorXd log_sizes) {
  constexpr int kMostRounds = 30;
  constexpr double kSettled = 1e-6;  // of ln σ
  const auto count = static_cast<Eigen::Index>(profiles.size());
  const Eigen::Index r = rest.cols() - 1;
  FittedSizes out{std::move(log_sizes), Eigen::VectorXd::Ones(count)};
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::MatrixXd joint = joint_information(profiles, rest, out.log_sizes);
    const Eigen::LLT<Eigen::MatrixXd> root(joint.topLeftCorner(r, r));
    Eigen::VectorXd change(r + 1);
    change << -root.solve(joint.topRightCorner(r, 1)), 1.0;
    const Eigen::MatrixXd inverse = root.solve(Eigen::MatrixXd::Identity(r, r));
    const Eigen::VectorXd before = out.log_sizes;
    for (Eigen::Index i = 0; i < count; ++i) {
      const ProfileInformation& own = profiles[static_cast<std::size_t>(i)];
      const Eigen::MatrixXd rest_of_it = own.of_rest(before[i]);
      const double taken =
          own.taken_by_bounded(before[i]) +
          inverse.cwiseProduct(rest_of_it.topLeftCorner(r, r)).sum() * std::exp(-2.0 * before[i]);
      out.freedom[i] = std::max(kLeastFreedom, own.freedom - taken);  // also of NaN
      const double square = std::max((rest_of_it * change).dot(change), 1e-300);
      out.log_sizes[i] = settled(before[i], out.freedom[i], square, before.mean(),
                                 count > 1 ? likeness : INFINITY);
    }
    if ((out.log_sizes - before).lpNorm<Eigen::Infinity>() < kSettled) break;
  }
  const double unlike = (out.log_sizes.array() - out.log_sizes.mean()).square().sum();
  out.cost = restricted_cost(profiles, rest, out.log_sizes) + unlike / (likeness * likeness);
  return out;
}

}  // namespace slideway
