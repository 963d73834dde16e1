#include <algorithm>
#include <cmath>
#include <map>

#include "kept_values.hpp"
#include "restricted_likelihood.hpp"
#include "slideway/base/parallel.hpp"
#include "slideway/identify/noise_model.hpp"
#include "whole_residuals.hpp"

namespace slideway {
namespace {

/// All profiles beside what is free, and what each says under its noise.
class WholeCosts {
 public:
  WholeCosts(const Linearisation& linear, const Gates& gates,
             const std::vector<Eigen::MatrixXd>& suspect, const std::vector<Noise>& noise)
      : gates_(gates) {
    const WholeResiduals whole(linear, noise, gates);
    for (std::size_t i = 0; i < noise.size(); ++i)
      profiles_.push_back(kept(whole.of(i, suspect.empty() ? Eigen::MatrixXd() : suspect[i]),
                               *linear.observations[i]));
    for (std::size_t i = 0; i < noise.size(); ++i) {
      likelihoods_.emplace_back(profiles_[i]);
      shared_.push_back(likelihoods_[i].under(noise[i].covariance()).of_shared(0.0));
    }
    const Eigen::MatrixXd priors = whole.priors();
    priors_ = Eigen::MatrixXd::Zero(priors.rows() + 1, priors.cols() + 1);
    priors_.topLeftCorner(priors.rows(), priors.cols()) = priors;
  }

  /// -2 ln of the likelihood where the members of a pool have these covariances.
  [[nodiscard]] double of(const std::vector<std::size_t>& pool,
                          const std::vector<ExponentialMixture>& covariances) const {
    Eigen::MatrixXd rest = priors_;
    for (std::size_t i = 0; i < profiles_.size(); ++i)
      if (std::ranges::find(pool, i) == pool.end()) rest += shared_[i];
    std::vector<ProfileInformation> information;
    for (std::size_t k = 0; k < pool.size(); ++k)
      information.push_back(likelihoods_[pool[k]].under(covariances[k]));
    return fit_sizes(information, rest, gates_.noise_likeness,
                     Eigen::VectorXd::Zero(std::ssize(pool)))
        .cost;
  }

 private:
  const Gates& gates_;
  std::vector<LinearProfile> profiles_;
  std::vector<ProfileLikelihood> likelihoods_;  // of these
  std::vector<Eigen::MatrixXd> shared_;
  Eigen::MatrixXd priors_;
};

void rule_out(const WholeCosts& costs, const std::vector<std::size_t>& pool,
              std::vector<Noise>& noise) {
  const auto covariances = [&](const auto& of) {
    std::vector<ExponentialMixture> out;
    for (const std::size_t i : pool) out.push_back(of(noise[i]));
    return out;
  };
  const std::vector<Noise::Alternative> allowed = noise[pool.front()].alternatives;
  const auto likeliest = static_cast<std::size_t>(
      std::ranges::max_element(allowed, {}, &Noise::Alternative::probability) - allowed.begin());
  const double least = costs.of(pool, covariances([](const Noise& n) { return n.covariance(); }));
  std::vector<double> probabilities(allowed.size(), 0.0);
  parallel_for(allowed.size(), [&](std::size_t g) {
    if (g == likeliest) return;
    const double cost =
        costs.of(pool, covariances([&](const Noise& n) { return n.alternatives[g].covariance; }));
    probabilities[g] = std::min(allowed[g].probability,
                                allowed[likeliest].probability * std::exp(-0.5 * (cost - least)));
  });
  double rest = 1.0;
  for (const double each : probabilities) rest -= each;
  probabilities[likeliest] = rest;
  for (const std::size_t i : pool)
    for (std::size_t g = 0; g < probabilities.size(); ++g)
      noise[i].alternatives[g].probability = probabilities[g];
}

}  // namespace

void rule_out_by_whole(const Linearisation& linear, const Gates& gates,
                       const std::vector<Eigen::MatrixXd>& suspect, std::vector<Noise>& noise) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> pools;
  for (std::size_t i = 0; i < noise.size(); ++i)
    if (noise[i].is_estimated() && noise[i].alternatives.size() > 1)
      pools[{noise[i].pool, noise[i].alternatives.size()}].push_back(i);
  if (pools.empty()) return;
  const WholeCosts costs(linear, gates, suspect, noise);
  for (const auto& [key, pool] : pools) rule_out(costs, pool, noise);
}

}  // namespace slideway
