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

/// White slow cosines of unit length, and their inner products with one another, the model's
/// columns and the residual, nuisances eliminated.
struct SlowProducts {
  Eigen::MatrixXd own, columns;
  Eigen::VectorXd residual;

  SlowProducts(const Observation& observation, const Noise& noise, const Eigen::MatrixXd& of_model,
               const Eigen::VectorXd& rest, Eigen::Index count) {
    const Eigen::Index m = observation.nuisances.cols(), k = of_model.cols(), n = rest.size();
    Eigen::MatrixXd rows(n, m + count + k + 1);
    rows << observation.nuisances, slow_cosines(n, count), of_model, rest;
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
    own = gram.middleCols(m, count);
    columns = gram.middleCols(m + count, k);
    residual = gram.rightCols(1);
  }
};

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
  Eigen::Index total = 0, next = 0;
  for (const Observation* observation : linear.observations) {
    counts.push_back(slow_cosine_count(observation->values.size(), gates));
    total += counts.back();
  }
  if (total == 0) return {};
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(total, total), inside(total, basis.cols());
  Eigen::VectorXd products(total);
  double mean = 0.0, variance = 0.0;
  std::map<std::size_t, double> by_memory;  // profiles of one pool are wrong about it together
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const SlowProducts slow(*linear.observations[i], noise[i], linear.columns[i],
                            linear.residuals[i], counts[i]);
    gram.block(next, next, counts[i], counts[i]) = slow.own;
    inside.middleRows(next, counts[i]) = slow.columns * basis;
    products.segment(next, counts[i]) = slow.residual;
    next += counts[i];
  }
  gram -= inside * inside.transpose();
  products -= inside * (basis.transpose() * (compressed.triangle.transpose() * compressed.target));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(gram);
  const Eigen::Index rank = (eigen.eigenvalues().array() > kSpanned).count();
  if (rank == 0) return {};
  const double found = (eigen.eigenvectors().rightCols(rank).transpose() * products)
                           .cwiseAbs2()
                           .cwiseQuotient(eigen.eigenvalues().tail(rank))
                           .sum();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double share = static_cast<double>(rank * counts[i]) / static_cast<double>(total);
    const double spread = std::min(noise[i].log_long_run_variance(), gates.noise_spread);
    const double size_spread = std::min(noise[i].log_size_variance(), spread);
    const double own = share * std::exp(0.5 * spread);
    const double below = noise[i].is_estimated() ? std::pow(gates.noise_extrapolation, 2) : 0.0;
    mean += own;
    variance += own * own * (std::expm1(size_spread) + below);
    by_memory[noise[i].pool] += own * std::sqrt(std::expm1(spread - size_spread));
  }
  for (const auto& [pool, common] : by_memory) variance += common * common;
  variance += 2.0 * mean * mean / static_cast<double>(rank);
  return {gamma_tail(mean * mean / variance, found * mean / variance), found / mean};
}

}  // namespace slideway
