#include "slideway/identify/noise.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "memory_lattice.hpp"
#include "restricted_likelihood.hpp"
#include "slideway/identify/linear_algebra.hpp"

namespace slideway {
namespace {

ExponentialMixture scaled(ExponentialMixture covariance, double factor) {
  covariance.white *= factor;
  covariance.variances *= factor;
  return covariance;
}

ExponentialMixture white_covariance(double deviation) { return scaled({}, deviation * deviation); }

Eigen::Index values_of(const LinearProfile& profile) {
  return std::max(profile.values, profile.residual.size());
}

/// State of the estimation: the information each profile gives under its present noise.
class Estimator {
 public:
  Estimator(std::span<const LinearProfile> profiles, const Eigen::MatrixXd& prior_information,
            const Gates& gates)
      : profiles_(profiles), gates_(gates), noise_(profiles.size()), information_(profiles.size()) {
    const Eigen::Index r = prior_information.cols();
    prior_ = Eigen::MatrixXd::Zero(r + 1, r + 1);
    prior_.topLeftCorner(r, r) = prior_information;
    for (std::size_t i = 0; i < profiles.size(); ++i) {
      pools_.resize(std::max(pools_.size(), profiles[i].pool + 1));
      pools_[profiles[i].pool].push_back(i);
      const double n = static_cast<double>(std::max<Eigen::Index>(profiles[i].residual.size(), 1));
      likelihoods_.emplace_back(profiles[i]);
      information_[i] = likelihoods_[i]
                            .under(white_covariance(profiles[i].residual.norm() / std::sqrt(n)))
                            .of_shared(0.0);
    }
    std::erase_if(pools_, [](const auto& pool) { return pool.empty(); });
  }

  std::vector<Noise> run() {
    // Pools are coupled only through a few shared parameters.
    const int sweeps = pools_.size() > 1 && prior_.cols() > 1 ? 3 : 1;
    for (int sweep = 0; sweep < sweeps; ++sweep)
      for (const std::vector<std::size_t>& pool : pools_) refine(pool);
    for (std::size_t i = 0; i < profiles_.size(); ++i)
      if (profiles_[i].declared) heed_declared(i);
    return std::move(noise_);
  }

 private:
  [[nodiscard]] Eigen::MatrixXd others(const std::vector<std::size_t>& pool) const {
    Eigen::MatrixXd rest = prior_;
    for (std::size_t j = 0; j < profiles_.size(); ++j)
      if (std::ranges::find(pool, j) == pool.end()) rest += information_[j];
    return rest;
  }

  void refine(const std::vector<std::size_t>& pool) {
    std::vector<const ProfileLikelihood*> members;
    for (const std::size_t i : pool) members.push_back(&likelihoods_[i]);
    const Eigen::MatrixXd rest = others(pool);
    const PoolMemory memory(members, rest, gates_);
    for (std::size_t k = 0; k < pool.size(); ++k) {
      const LinearProfile& profile = profiles_[pool[k]];
      std::vector<Noise::Alternative> alternatives;
      const auto own = static_cast<Eigen::Index>(k);
      for (const PoolMemory::Allowed& each : memory.allowed())
        alternatives.push_back(
            {each.probability, scaled(each.covariance, std::exp(2.0 * each.sizes.log_sizes[own]))});
      Noise& noise = noise_[pool[k]] = Noise(
          scaled(memory.best().covariance, std::exp(2.0 * memory.best().sizes.log_sizes[own])),
          values_of(profile), profile.trace);
      noise.alternatives = std::move(alternatives);
      noise.pool = profile.pool;
      noise.freedom = memory.best().sizes.freedom[own];
      noise.unlike_sisters = unlike(memory.best().sizes.log_sizes, own);
      information_[pool[k]] = likelihoods_[pool[k]].under(noise.covariance()).of_shared(0.0);
    }
  }

  /// Size over the mean of the others, if it is not within the gate of theirs.
  [[nodiscard]] std::optional<double> unlike(const Eigen::VectorXd& log_sizes,
                                             Eigen::Index own) const {
    const Eigen::Index others = log_sizes.size() - 1;
    if (others < 1) return std::nullopt;
    const double theirs = (log_sizes.sum() - log_sizes[own]) / static_cast<double>(others);
    const double ratio = std::exp(log_sizes[own] - theirs);
    if (ratio < gates_.unlike_noise && ratio > 1.0 / gates_.unlike_noise) return std::nullopt;
    return ratio;
  }

  void heed_declared(std::size_t i) {
    const LinearProfile& profile = profiles_[i];
    Noise& noise = noise_[i];
    const Eigen::MatrixXd rest = others({i});
    const auto cost = [&](const ExponentialMixture& covariance) {
      const ProfileInformation own = likelihoods_[i].under(covariance);
      return restricted_cost({&own, 1}, rest, Eigen::VectorXd::Zero(1));
    };
    const double gain = cost(white_covariance(*profile.declared)) - cost(noise.covariance());
    const double parameters = noise.is_white() ? 1.0 : 4.0;
    noise.overruled = gain > parameters * std::log(static_cast<double>(profile.residual.size())) +
                                 gates_.declared_noise_bic &&
                      noise.long_run_deviation() > *profile.declared;
    if (noise.overruled) return;
    noise = Noise::white(*profile.declared, values_of(profile));
    noise.declared = true;
    noise.pool = profile.pool;
  }

  std::span<const LinearProfile> profiles_;
  std::vector<ProfileLikelihood> likelihoods_;
  const Gates& gates_;
  Eigen::MatrixXd prior_;
  std::vector<std::vector<std::size_t>> pools_;
  std::vector<Noise> noise_;
  std::vector<Eigen::MatrixXd> information_;
};

}  // namespace

double LinearProfile::extent() const {
  return trace.empty() ? static_cast<double>(values_of(*this)) : trace.back() + 1.0;
}

Noise::Noise(const ExponentialMixture& covariance, Eigen::Index n, std::vector<double> stations)
    : covariance_(covariance),
      values_(n),
      stations_(std::move(stations)),
      factor_(covariance.is_white() ? nullptr
                                    : std::make_shared<const MixtureFactor>(factored(covariance))) {
}

MixtureFactor Noise::factored(const ExponentialMixture& covariance) const {
  return stations_.empty() ? MixtureFactor(covariance, values_)
                           : MixtureFactor(covariance, stations_);
}

double Noise::extent() const {
  return stations_.empty() ? static_cast<double>(values_) : stations_.back() + 1.0;
}

Noise Noise::white(double standard_deviation, Eigen::Index n) {
  return {white_covariance(standard_deviation), n};
}

Noise Noise::scaled(double factor) const {
  Noise out = *this;
  out.covariance_ = slideway::scaled(covariance_, factor);
  out.factor_ =
      out.is_white() ? nullptr : std::make_shared<const MixtureFactor>(factored(out.covariance_));
  for (Alternative& each : out.alternatives)
    each.covariance = slideway::scaled(each.covariance, factor);
  if (known_) out.set_known(known_->columns);
  return out;
}

Noise Noise::repeated(const Weight& weight) const {
  if (weight.memory == 1.0 && weight.white == 1.0) return *this;
  Noise out = *this;
  const auto multiply = [&](ExponentialMixture& covariance) {
    covariance.variances *= weight.memory;
    covariance.white *= weight.white;
  };
  multiply(out.covariance_);
  for (Alternative& each : out.alternatives) multiply(each.covariance);
  if (!out.is_white())
    out.factor_ = std::make_shared<const MixtureFactor>(factored(out.covariance_));
  out.weight_.memory *= weight.memory;
  out.weight_.white *= weight.white;
  if (known_) out.set_known(known_->columns);
  return out;
}

double Noise::standard_deviation() const {
  ExponentialMixture own = covariance_;
  own.variances /= weight_.memory;
  own.white /= weight_.white;
  if (is_white() || values_ < 2) return std::sqrt(own.variance());
  const auto n = static_cast<double>(values_);
  return std::sqrt((own.variance() - own.variance_of_mean(n)) * n / (n - 1.0));
}

double Noise::spectrum(const ExponentialMixture& covariance) const {
  return covariance.spectrum(values_ > 1 ? 1.0 / extent() : 0.5);
}

double Noise::power_ratio(const ExponentialMixture& other, double cycles) const {
  const double frequency = cycles / extent();
  return other.spectrum(frequency) / covariance_.spectrum(frequency);
}

double Noise::long_run_deviation() const { return std::sqrt(spectrum(covariance_)); }

double Noise::effective_values() const {
  const double deviation = standard_deviation(), slow = long_run_deviation();
  return static_cast<double>(values_) * std::min(deviation * deviation / (slow * slow), 1.0);
}

double Noise::log_size_variance() const { return is_estimated() ? 2.0 / freedom : 0.0; }

double Noise::log_long_run_variance() const {
  if (!is_estimated()) return 0.0;
  double mean = 0.0, square = 0.0;
  for (const auto& [probability, covariance] : alternatives) {
    const double value = std::log(spectrum(covariance) / spectrum(covariance_));
    mean += probability * value;
    square += probability * value * value;
  }
  return square - mean * mean + log_size_variance();
}

void Noise::add_known(const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd all = known_ ? known_->columns : Eigen::MatrixXd(columns.rows(), 0);
  append_columns(all, columns);
  set_known(all);
}

void Noise::set_known(const Eigen::MatrixXd& columns) {
  constexpr double kVisible = 1e-4;  // of the variance of the noise
  known_.reset();
  Eigen::MatrixXd white = columns;
  whiten(white);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(white.transpose() * white);
  const Eigen::VectorXd& variances = parts.eigenvalues();  // rising
  const Eigen::Index kept = (variances.array() > kVisible).count();
  if (kept == 0) return;
  const Eigen::VectorXd own = variances.tail(kept);
  known_ = std::make_shared<const KnownErrors>(KnownErrors{
      columns,
      white * parts.eigenvectors().rightCols(kept) * own.cwiseSqrt().cwiseInverse().asDiagonal(),
      (1.0 + own.array()).sqrt()});
}

void Noise::whiten(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (factor_ && factor_->rows() == rows.rows())
    factor_->whiten(rows);
  else
    MixtureFactor(covariance_, rows.rows()).whiten(rows);
  if (!known_ || known_->directions.rows() != rows.rows()) return;
  const Eigen::VectorXd shorter = 1.0 - known_->deviations.array().inverse();
  rows -=
      known_->directions * (shorter.asDiagonal() * (known_->directions.transpose() * rows)).eval();
}

void Noise::colour(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (known_ && known_->directions.rows() == rows.rows()) {
    const Eigen::VectorXd longer = known_->deviations.array() - 1.0;
    rows +=
        known_->directions * (longer.asDiagonal() * (known_->directions.transpose() * rows)).eval();
  }
  if (factor_ && factor_->rows() == rows.rows())
    factor_->colour(rows);
  else
    MixtureFactor(covariance_, rows.rows()).colour(rows);
}

std::vector<Noise> estimate_noise(std::span<const LinearProfile> profiles,
                                  const Eigen::MatrixXd& prior_information, const Gates& gates) {
  return Estimator(profiles, prior_information, gates).run();
}

}  // namespace slideway
