#include "slideway/signal/exponential_mixture.hpp"

#include <array>
#include <cmath>
#include <map>
#include <type_traits>

#include "slideway/base/units.hpp"
#include "slideway/base/wide.hpp"

namespace slideway {
namespace {

using Terms = ExponentialMixture::Terms;
constexpr int kTerms = ExponentialMixture::kTerms;
constexpr int kLong = kTerms - 1;  // terms of a long memory alone

/// Variance of the mean over a length, of noise with unit variance; 1 - x/3 for small x.
Terms mean_over(const Terms& length) {
  return (length < 1e-4)
      .select(1.0 - length / 3.0, 2.0 / length * (1.0 + (-length).expm1() / length));
}

std::vector<double> steps_between(std::span<const double> stations) {
  std::vector<double> out(stations.size(), 1.0);
  for (std::size_t i = 1; i < out.size(); ++i) out[i] = stations[i] - stations[i - 1];
  return out;
}

}  // namespace

double ExponentialMixture::variance() const {
  return white + (variances * mean_over(1.0 / lengths)).sum();
}

double ExponentialMixture::covariance(double distance) const {
  return (continued() * (-distance / lengths).exp()).sum();
}

double ExponentialMixture::variance_of_mean(double n) const {
  return white / n + (variances * mean_over(n / lengths)).sum();
}

ExponentialMixture ExponentialMixture::of_means(double neighbours) const {
  ExponentialMixture out = *this;
  out.white /= neighbours;
  out.lengths /= neighbours;
  return out;
}

Terms ExponentialMixture::continued() const {
  constexpr double kShortest = 0.005;  // neighbours of shorter ones share L / 2 of their variance
  const Terms felt = (lengths < kShortest).select(0.0, variances);
  return felt * (2.0 * lengths * (0.5 / lengths.max(kShortest)).sinh()).square();
}

double ExponentialMixture::spectrum(double cycles_per_value) const {
  const Terms alone = continued(), rho = (-1.0 / lengths).exp();
  const double cosine = std::cos(2.0 * kPi * cycles_per_value);
  const Terms sums = (1.0 - rho) * (1.0 + rho) / (1.0 - 2.0 * cosine * rho + rho.square());
  return variance() + (alone * (sums - 1.0)).sum();
}

Terms ExponentialMixture::spread_lengths(double first, double last) {
  return Terms::LinSpaced(std::log(first), std::log(last)).exp();
}

MixtureFactor::MixtureFactor(const ExponentialMixture& noise, Eigen::Index n) : deviation_(n) {
  factorise(noise, {});
}

MixtureFactor::MixtureFactor(const ExponentialMixture& noise, std::span<const double> stations)
    : deviation_(std::ssize(stations)) {
  factorise(noise, steps_between(stations));
}

void MixtureFactor::factorise(const ExponentialMixture& noise, const std::vector<double>& steps) {
  Terms rates = noise.lengths.inverse(), amplitudes = noise.continued();
  const double variance = noise.variance();
  const Eigen::Index terms = (noise.variances != 0.0).count();
  if (terms == 0) {
    deviation_.setConstant(std::sqrt(variance));
    return;
  }
  if (terms == 1) {
    Eigen::Index which = 0;
    amplitudes.maxCoeff(&which);
    rates[0] = rates[which];
    amplitudes[0] = amplitudes[which];
  }
  const bool is_long_alone = terms == kLong && noise.variances[0] == 0.0;
  if (is_long_alone) {
    rates.head<kLong>() = rates.tail<kLong>().eval();
    amplitudes.head<kLong>() = amplitudes.tail<kLong>().eval();
  }
  set_decays(rates, steps);
  if (terms == 1)
    factorise<1>(variance, amplitudes);
  else if (is_long_alone)
    factorise<kLong>(variance, amplitudes);
  else
    factorise<kTerms>(variance, amplitudes);
}

void MixtureFactor::set_decays(const Terms& rates, const std::vector<double>& steps) {
  if (steps.empty()) decays_.emplace_back((-rates).exp());
  std::map<double, std::uint32_t> known;
  decay_of_.reserve(steps.size());
  for (const double step : steps) {
    if (!decay_of_.empty() && step == steps[decay_of_.size() - 1]) {
      decay_of_.push_back(decay_of_.back());
      continue;
    }
    const auto [found, is_new] =
        known.try_emplace(step, static_cast<std::uint32_t>(decays_.size()));
    if (is_new) decays_.emplace_back((-step * rates).exp());
    decay_of_.push_back(found->second);
  }
}

template <int Count>
void MixtureFactor::factorise(double variance, const Terms& all) {
  count_ = Count;
  gains_.resize(static_cast<std::size_t>(rows() * Count));
  using Square = Eigen::Matrix<double, Count, Count>;
  using Vector = Eigen::Matrix<double, Count, 1>;
  const Vector amplitudes = all.head<Count>();
  Square state = Square::Zero(), decays = Square::Zero();
  for (Eigen::Index row = 0; row < rows(); ++row) {
    if (row == 0 || (!decay_of_.empty() && &decay(row) != &decay(row - 1))) {
      const Vector once = decay(row).head<Count>();
      decays = once * once.transpose();
    }
    state = state.cwiseProduct(decays).eval();
    const Vector product = state * amplitudes;
    const double left = variance - amplitudes.dot(product);
    Eigen::Map<Vector> gain(gains_.data() + row * Count);
    gain = (1.0 - product.array()).matrix() / left;
    deviation_[row] = std::sqrt(left);
    state += left * gain * gain.transpose();
    gain.array() *= amplitudes.array();
  }
}

template <int Count, int Columns, MixtureFactor::Direction direction>
void MixtureFactor::filter(double* first, Eigen::Index stride) const {
  using Lane = std::array<double, Columns>;
  std::array<Lane, Count> memory{};
  const double* gain = gains_.data();
  for (Eigen::Index row = 0; row < rows(); ++row, gain += Count) {
    const Terms& decays = decay(row);
    Lane predicted{}, left;
    for (int k = 0; k < Count; ++k)
      for (int c = 0; c < Columns; ++c) {
        memory[k][c] *= decays[k];
        predicted[c] += memory[k][c];
      }
    for (int c = 0; c < Columns; ++c) {
      double& value = first[row + c * stride];
      if constexpr (direction == Direction::whiten) {
        left[c] = value - predicted[c];
        value = left[c] / deviation_[row];
      } else {
        left[c] = value * deviation_[row];
        value = left[c] + predicted[c];
      }
    }
    for (int k = 0; k < Count; ++k)
      for (int c = 0; c < Columns; ++c) memory[k][c] += gain[k] * left[c];
  }
}

template <int Count, MixtureFactor::Direction direction>
void MixtureFactor::filter(Eigen::Ref<Eigen::MatrixXd> rows) const {
  wide([&] {  // many columns at once keep the processor busy
    Eigen::Index column = 0;
    const auto take = [&]<int Many>(std::integral_constant<int, Many>) {
      for (; column + Many <= rows.cols(); column += Many)
        filter<Count, Many, direction>(rows.col(column).data(), rows.outerStride());
    };
    take(std::integral_constant<int, 8>());
    take(std::integral_constant<int, 4>());
    take(std::integral_constant<int, 2>());
    take(std::integral_constant<int, 1>());
  });
}

template <MixtureFactor::Direction direction>
void MixtureFactor::filter_all(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (count_ == 1)
    filter<1, direction>(rows);
  else if (count_ == kLong)
    filter<kLong, direction>(rows);
  else
    filter<kTerms, direction>(rows);
}

void MixtureFactor::whiten(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (count_ == 0)
    rows.array().colwise() /= deviation_;
  else
    filter_all<Direction::whiten>(rows);
}

void MixtureFactor::colour(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (count_ == 0)
    rows.array().colwise() *= deviation_;
  else
    filter_all<Direction::colour>(rows);
}

double MixtureFactor::log_determinant() const { return 2.0 * deviation_.log().sum(); }

}  // namespace slideway
