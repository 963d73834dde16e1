#include "restricted_likelihood.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
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
    joint += profiles[i].gram * std::exp(-2.0 * log_sizes[static_cast<Eigen::Index>(i)]);
  return joint;
}

}  // namespace

ProfileInformation::ProfileInformation(const LinearProfile& profile,
                                       const ExponentialMixture& covariance) {
  const Eigen::Index n = profile.residual.size(), m = profile.nuisances.cols();
  const Eigen::Index r = profile.columns.cols();
  // Others of the model act in other profiles alone: feed marks of other cuts.
  std::vector<Eigen::Index> acting;
  for (Eigen::Index k = 0; k < r; ++k)
    if ((profile.columns.col(k).array() != 0.0).any()) acting.push_back(k);
  const auto a = std::ssize(acting);
  const MixtureFactor factor = profile.stations.empty()
                                   ? MixtureFactor(covariance, n)
                                   : MixtureFactor(covariance, profile.stations);
  Eigen::MatrixXd rows(n, m + a + 1);
  rows << profile.nuisances, profile.columns(Eigen::all, acting), profile.residual;
  factor.whiten(rows);
  Eigen::MatrixXd own = gram_of(rows);
  acting.push_back(r);
  freedom = static_cast<double>(n - m);
  log_determinants = factor.log_determinant();
  if (m > 0) {
    const Eigen::LLT<Eigen::MatrixXd> nuisance(own.topLeftCorner(m, m));
    if (nuisance.info() != Eigen::Success) log_determinants = INFINITY;
    log_determinants += 2.0 * nuisance.matrixLLT().diagonal().array().log().sum();
    const Eigen::MatrixXd cross = nuisance.matrixL().solve(own.topRightCorner(m, a + 1));
    own = (own.bottomRightCorner(a + 1, a + 1) - cross.transpose() * cross).eval();
  }
  gram = Eigen::MatrixXd::Zero(r + 1, r + 1);
  gram(acting, acting) = own;
}

double restricted_cost(std::span<const ProfileInformation> profiles, const Eigen::MatrixXd& rest,
                       const Eigen::VectorXd& log_sizes) {
  double cost = 0.0;
  for (std::size_t i = 0; i < profiles.size(); ++i)
    cost += profiles[i].log_determinants +
            2.0 * profiles[i].freedom * log_sizes[static_cast<Eigen::Index>(i)];
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
      const double taken =
          inverse.cwiseProduct(own.gram.topLeftCorner(r, r)).sum() * std::exp(-2.0 * before[i]);
      out.freedom[i] = std::max(kLeastFreedom, own.freedom - taken);  // also of NaN
      const double square = std::max((own.gram * change).dot(change), 1e-300);
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
