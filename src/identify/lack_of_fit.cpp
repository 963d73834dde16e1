#include "slideway/identify/lack_of_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "slideway/base/distribution.hpp"
#include "slideway/identify/identifiability.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

constexpr double kSpanned = 1e-6;  // of a unit cosine outside the model: it is the model's own

/// What one profile's slow cosines span, white, nuisances eliminated: orthonormal directions.
struct SlowDirections {
  Eigen::MatrixXd of_model;  // their products with the model's columns
  Eigen::VectorXd residual;  // and with the residual

  SlowDirections(const Observation& observation, const Noise& noise, const Eigen::MatrixXd& model,
                 const Eigen::VectorXd& rest, Eigen::Index count) {
    const Eigen::Index m = observation.nuisances.cols(), k = model.cols(), n = rest.size();
    Eigen::MatrixXd rows(n, m + count + k + 1);
    rows << observation.nuisances, slow_cosines(n, count), model, rest;
    noise.whiten(rows);
    for (Eigen::Index j = 0; j < count; ++j) rows.col(m + j).normalize();
    Eigen::MatrixXd gram = rows.middleCols(m, count).transpose() * rows;
    if (m > 0) {
      const Eigen::MatrixXd nuisances = rows.leftCols(m);
      const Eigen::MatrixXd solved = (nuisances.transpose() * nuisances)
                                         .completeOrthogonalDecomposition()
                                         .solve(nuisances.transpose() * rows);
      gram -= gram.leftCols(m).eval() * solved;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> own(gram.middleCols(m, count));
    const Eigen::Index rank = (own.eigenvalues().array() > kSpanned).count();
    const Eigen::MatrixXd directions =
        own.eigenvectors().rightCols(rank) *
        own.eigenvalues().tail(rank).cwiseSqrt().cwiseInverse().asDiagonal();
    of_model = directions.transpose() * gram.middleCols(m + count, k);
    residual = directions.transpose() * gram.rightCols(1);
  }
};

/// Mean and variance of the square that noise leaves in the slow band.
struct Moments {
  double mean = 0.0, variance = 0.0;

  void operator+=(const Moments& other) { mean += other.mean, variance += other.variance; }
};

/// A memory that a pool of profiles may have.
struct AllowedMemory {
  double probability = 1.0;
  Moments square;
};

/// Of one profile under one of the noises it may have.
/// @param share  directions of the slow band that are this profile's
Moments moments(const Noise& noise, const ExponentialMixture& covariance, double share,
                Eigen::Index count, const Gates& gates) {
  if (count == 0) return {};
  double mean = 0.0, square = 0.0;
  for (Eigen::Index j = 1; j <= count; ++j) {
    const double ratio = noise.power_ratio(covariance, 0.5 * static_cast<double>(j));
    mean += ratio / static_cast<double>(count);
    square += ratio * ratio / static_cast<double>(count);
  }
  const double below = noise.is_estimated() ? std::pow(gates.noise_extrapolation, 2) : 0.0;
  const double own = share * mean;
  return {own, 2.0 * share * square + own * own * (std::expm1(noise.log_size_variance()) + below)};
}

/// What each pool may leave, the least first.
std::vector<std::vector<AllowedMemory>> allowed_memories(const std::vector<double>& shares,
                                                         const std::vector<Eigen::Index>& counts,
                                                         const std::vector<Noise>& noise,
                                                         const Gates& gates) {
  std::map<std::size_t, std::vector<AllowedMemory>> pools;
  std::vector<std::vector<AllowedMemory>> out;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    const auto of = [&](const ExponentialMixture& covariance) {
      return moments(noise[i], covariance, shares[i], counts[i], gates);
    };
    if (!noise[i].is_estimated()) {
      out.push_back({{1.0, of(noise[i].covariance())}});
      continue;
    }
    std::vector<AllowedMemory>& pool = pools[noise[i].pool];
    pool.resize(noise[i].alternatives.size());
    for (std::size_t g = 0; g < pool.size(); ++g) {
      pool[g].probability = noise[i].alternatives[g].probability;
      pool[g].square += of(noise[i].alternatives[g].covariance);
    }
  }
  for (auto& [pool, memories] : pools) out.push_back(std::move(memories));
  for (std::vector<AllowedMemory>& memories : out)
    std::ranges::sort(memories, {}, [](const AllowedMemory& each) { return each.square.mean; });
  return out;
}

/// The mean over all noises that are allowed; pools are taken to be wrong together, for they are
/// estimated beside the same model.
LackOfFit judged(double found, const std::vector<double>& shares,
                 const std::vector<Eigen::Index>& counts, const std::vector<Noise>& noise,
                 const Gates& gates) {
  const auto pools = allowed_memories(shares, counts, noise, gates);
  std::vector<std::size_t> at(pools.size(), 0);
  std::vector<double> until(pools.size(), 0.0);
  // The last memory of a pool holds to the end, however the probabilities have been rounded.
  const auto extend = [&](std::size_t k) {
    until[k] = at[k] + 1 < pools[k].size() ? until[k] + pools[k][at[k]].probability : 1.0;
  };
  for (std::size_t k = 0; k < pools.size(); ++k) extend(k);
  LackOfFit out{0.0, 0.0};
  double expected = 0.0;
  for (double done = 0.0; done < 1.0;) {
    const double next = std::ranges::min(until);
    Moments sum;
    for (std::size_t k = 0; k < pools.size(); ++k) sum += pools[k][at[k]].square;
    const double scale = sum.mean / sum.variance;
    const bool is_known = sum.mean * scale > 0.0;  // else noise of that size leaves anything
    out.p_value += (next - done) * (is_known ? gamma_tail(sum.mean * scale, found * scale) : 1.0);
    expected += (next - done) * sum.mean;
    done = next;
    for (std::size_t k = 0; k < pools.size(); ++k)
      if (until[k] <= done && at[k] + 1 < pools[k].size()) {
        ++at[k];
        extend(k);
      }
  }
  out.ratio = found / expected;
  return out;
}

}  // namespace

bool LackOfFit::significant(const Gates& gates) const {
  return p_value < gates.lack_of_fit_p && ratio > gates.lack_of_fit_ratio;
}

LackOfFit lack_of_fit(const Linearisation& linear, const std::vector<Noise>& noise,
                      const Gates& gates) {
  const Compressed compressed = compress(linear, noise);
  const Eigen::MatrixXd basis =
      analyse_rank(compressed.triangle, compressed.scale, gates.rank_tolerance).basis;
  std::vector<Eigen::Index> counts;
  // With S the slow directions, orthonormal, M the model's and r the residual outside M, the square
  // of r in what S adds to M is |Sᵀr|² + wᵀ K⁻¹ w: w = -Mᵀ S Sᵀr, K = I - Mᵀ S Sᵀ M.
  const Eigen::VectorXd in_model =
      basis.transpose() * (compressed.triangle.transpose() * compressed.target);
  Eigen::Index total = 0, rank = 0;
  double found = 0.0;
  Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(basis.cols(), basis.cols());  // K
  Eigen::VectorXd against = Eigen::VectorXd::Zero(basis.cols());                 // w
  for (std::size_t i = 0; i < linear.observations.size(); ++i) {
    const Observation& observation = *linear.observations[i];
    counts.push_back(slow_cosine_count(observation.values.size(), gates));
    if (counts.back() == 0) continue;
    total += counts.back();
    const SlowDirections slow(observation, noise[i], linear.columns[i], linear.residuals[i],
                              counts.back());
    const Eigen::MatrixXd inside = slow.of_model * basis;
    const Eigen::VectorXd outside = slow.residual - inside * in_model;
    rank += outside.size();
    found += outside.squaredNorm();
    rest -= inside.transpose() * inside;
    against -= inside.transpose() * outside;
  }
  if (basis.cols() > 0) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(rest);
    const Eigen::Index left = (eigen.eigenvalues().array() > kSpanned).count();
    rank -= basis.cols() - left;
    found += (eigen.eigenvectors().rightCols(left).transpose() * against)
                 .cwiseAbs2()
                 .cwiseQuotient(eigen.eigenvalues().tail(left))
                 .sum();
  }
  if (rank <= 0) return {};
  std::vector<double> shares;
  for (const Eigen::Index count : counts)
    shares.push_back(static_cast<double>(rank * count) / static_cast<double>(total));
  return judged(found, shares, counts, noise, gates);
}

}  // namespace slideway
