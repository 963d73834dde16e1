#include "slideway/identify/uncertainty.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "restricted_likelihood.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

constexpr double kLeastShare =
    0.05;                          // of the most probable noise: others move a variance by chance
constexpr double kInfinite = 1e6;  // degrees of freedom: above it k is 2, and they are rounding

/// Information of one profile on w under a noise, its nuisances eliminated.
Eigen::MatrixXd information_under(const MixtureFactor& noise, const LinearProfile& profile) {
  const Eigen::Index m = profile.nuisances.cols(), r = profile.columns.cols();
  Eigen::MatrixXd rows(profile.columns.rows(), m + r);
  rows << profile.nuisances, profile.columns;
  noise.whiten(rows);
  Eigen::MatrixXd gram = rows.transpose() * rows;
  if (m == 0) return gram;
  const Eigen::MatrixXd cross = gram.topRightCorner(m, r);
  return gram.bottomRightCorner(r, r) -
         cross.transpose() *
             gram.topLeftCorner(m, m).completeOrthogonalDecomposition().solve(cross);
}

/// What another noise adds to the information of one profile. Where block means may stand for it,
/// both are of these.
Eigen::MatrixXd more_information(const ProfileLikelihood& of, const Noise& noise,
                                 const ExponentialMixture& other, const Eigen::MatrixXd& known) {
  if (!of.is_thinned()) return information_under(noise.factored(other), of.profile()) - known;
  const Eigen::Index r = known.rows();
  return (of.nearly_under(other).of_shared(0.0) -
          of.nearly_under(noise.covariance()).of_shared(0.0))
      .topLeftCorner(r, r);
}

/// What the mean over the noises that the residuals of one pool allow adds to the covariance of w
/// under the most probable one.
Eigen::MatrixXd spread_of_noises(const std::vector<std::size_t>& members,
                                 const std::vector<Noise>& noise, const Linearisation& linear,
                                 const Uncertainty& at_best) {
  const Eigen::Index r = at_best.basis.cols();
  const std::vector<Noise::Alternative>& allowed = noise[members.front()].alternatives;
  const double least =
      kLeastShare * std::ranges::max(allowed, {}, &Noise::Alternative::probability).probability;
  const std::size_t count = allowed.size();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(r, r);
  if (count < 2 || r == 0) return out;
  std::vector<LinearProfile> profiles;
  for (const std::size_t i : members) {
    const Observation& observation = *linear.observations[i];
    profiles.push_back({observation.nuisances, linear.columns[i] * at_best.basis,
                        Eigen::VectorXd::Zero(observation.values.size())});
  }
  const std::vector<ProfileLikelihood> of(profiles.begin(), profiles.end());
  std::vector<Eigen::MatrixXd> under(count);
  parallel_for(count, [&](std::size_t g) {
    if (allowed[g].probability < least) return;
    Eigen::MatrixXd total = Eigen::MatrixXd::Identity(r, r);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::size_t i = members[k];
      total += more_information(of[k], noise[i], noise[i].alternatives[g].covariance,
                                at_best.information[i]);
    }
    under[g] = total.completeOrthogonalDecomposition().pseudoInverse();
  });
  double sum = 0.0;
  for (std::size_t g = 0; g < count; ++g) {
    if (allowed[g].probability < least) continue;
    out += allowed[g].probability * (under[g] - Eigen::MatrixXd::Identity(r, r));
    sum += allowed[g].probability;
  }
  return out / sum;
}

/// The estimated profiles by their pool.
std::vector<std::vector<std::size_t>> pools_of(const std::vector<Noise>& noise) {
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    if (!noise[i].is_estimated()) continue;
    out.resize(std::max(out.size(), noise[i].pool + 1));
    out[noise[i].pool].push_back(i);
  }
  std::erase_if(out, [](const auto& pool) { return pool.empty(); });
  return out;
}

}  // namespace

Spread Uncertainty::of(const Eigen::RowVectorXd& row) const {
  const Eigen::RowVectorXd c = row * basis;
  // Beside a large part of the covariance a small one is rounding: the number is known no better.
  const double rounding = std::numeric_limits<double>::epsilon() * static_cast<double>(c.size()) *
                          c.squaredNorm() * (c.size() > 0 ? covariance.cwiseAbs().maxCoeff() : 0.0);
  const double variance = std::max((c * covariance * c.transpose()).value(), rounding);
  Spread spread{std::sqrt(inflation * variance), std::nullopt};
  if (!(variance > 0.0)) return spread;
  std::vector<double> parts;  // of the variance, by profile
  for (const Eigen::MatrixXd& of_profile : information)
    parts.push_back((c * of_profile * c.transpose()).value());
  const double whole = has_curve ? std::accumulate(parts.begin(), parts.end(), 0.0) : variance;
  double spread_of_log = 0.0;
  for (std::size_t i = 0; i < size_freedom.size(); ++i) {
    if (size_freedom[i] == 0.0) continue;
    const double share = parts[i] / whole;
    spread_of_log += 2.0 * share * share / size_freedom[i];
  }
  const double freedom = 2.0 / spread_of_log;
  if (spread_of_log > 0.0 && freedom < kInfinite)
    spread.degrees_of_freedom = std::max(1.0, freedom);
  return spread;
}

void Uncertainty::add(const Eigen::MatrixXd& more, const Compressed& compressed) {
  const Eigen::MatrixXd to_basis =
      basis.transpose() * compressed.triangle.transpose() * compressed.triangle;
  covariance += to_basis * more * to_basis.transpose() / inflation;
}

Uncertainty assess(const Linearisation& linear, const Compressed& compressed,
                   const std::vector<Noise>& noise, const Eigen::MatrixXd& basis,
                   double inflation) {
  const Eigen::Index r = basis.cols();
  Uncertainty out;
  out.inflation = inflation;
  out.basis = basis;
  out.covariance = Eigen::MatrixXd::Identity(r, r);
  const std::vector<std::vector<std::size_t>> pools = pools_of(noise);
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const ProfileTriangle& profile = compressed.profiles[i];
    const Eigen::MatrixXd rows = profile.free().leftCols(profile.columns()) * basis;
    const Eigen::MatrixXd& information = out.information.emplace_back(rows.transpose() * rows);
    out.size_freedom.push_back(noise[i].is_estimated() ? noise[i].freedom : 0.0);
    const double own =
        pools.size() > 1 ? noise[i].log_long_run_variance() : noise[i].log_size_variance();
    out.covariance += 2.0 * own * (information - information * information);
  }
  for (const std::vector<std::size_t>& members : pools)
    out.covariance += spread_of_noises(members, noise, linear, out);
  const Eigen::MatrixXd of_columns = basis * out.covariance * basis.transpose();
  for (const ProfileTriangle& profile : compressed.profiles)
    out.nuisance_covariances.emplace_back(inflation * profile.levelling_covariance(of_columns));
  return out;
}

double coverage_factor(const std::optional<double>& degrees_of_freedom) {
  constexpr double kOutside = 0.5 * (1.0 - 0.954499736103642);  // beyond two standard deviations
  if (!degrees_of_freedom) return 2.0;
  return student_limit(*degrees_of_freedom, kOutside);
}

}  // namespace slideway
