#include "slideway/signal/exponential_mixture.hpp"

#include <array>
#include <cmath>

#include "slideway/base/units.hpp"

namespace slideway {
namespace {

using Terms = ExponentialMixture::Terms;
constexpr int kTerms = ExponentialMixture::kTerms;

/// Covariance of block means, continued to the distance 0.
Terms continued(const ExponentialMixture& noise) {
  return noise.variances * (2.0 * noise.lengths * (0.5 / noise.lengths).sinh()).square();
}

/// Variance of the mean over a length, of noise with unit variance; 1 - x/3 for small x.
Terms mean_over(const Terms& length) {
  return (length < 1e-4)
      .select(1.0 - length / 3.0, 2.0 / length * (1.0 + (-length).expm1() / length));
}

}  // namespace

double ExponentialMixture::variance() const {
  return white + (variances * mean_over(1.0 / lengths)).sum();
}

double ExponentialMixture::covariance(double distance) const {
  return (continued(*this) * (-distance / lengths).exp()).sum();
}

double ExponentialMixture::variance_of_mean(double n) const {
  return white / n + (variances * mean_over(n / lengths)).sum();
}

double ExponentialMixture::spectrum(double cycles_per_value) const {
  const Terms alone = continued(*this), rho = (-1.0 / lengths).exp();
  const double cosine = std::cos(2.0 * kPi * cycles_per_value);
  const Terms sums = (1.0 - rho) * (1.0 + rho) / (1.0 - 2.0 * cosine * rho + rho.square());
  return variance() + (alone * (sums - 1.0)).sum();
}

Terms ExponentialMixture::spread_lengths(double first, double last) {
  return Terms::LinSpaced(std::log(first), std::log(last)).exp();
}

MixtureFactor::MixtureFactor(const ExponentialMixture& noise, Eigen::Index n)
    : gains_(kTerms, n), deviation_(n) {
  factorise(noise);
}

MixtureFactor::MixtureFactor(const ExponentialMixture& noise, std::span<const double> stations)
    : gains_(kTerms, std::ssize(stations)), deviation_(std::ssize(stations)) {
  for (std::size_t i = 0; i < stations.size(); ++i)
    steps_.push_back(i == 0 ? 1.0 : stations[i] - stations[i - 1]);
  factorise(noise);
}

Terms MixtureFactor::decay(Eigen::Index row) const {
  return (-(steps_.empty() ? 1.0 : steps_[static_cast<std::size_t>(row)]) * rates_).exp();
}

void MixtureFactor::factorise(const ExponentialMixture& noise) {
  white_ = noise.is_white();
  rates_ = noise.lengths.inverse();
  amplitudes_ = continued(noise);
  const double variance = noise.variance();
  if (white_) {
    gains_.resize(kTerms, 0);
    deviation_.setConstant(std::sqrt(variance));
    return;
  }
  using Square = Eigen::Matrix<double, kTerms, kTerms>;
  const auto amplitudes = amplitudes_.matrix();
  Square state = Square::Zero();
  Square decays = (decay(0).matrix() * decay(0).matrix().transpose()).eval();
  for (Eigen::Index row = 0; row < rows(); ++row) {
    if (row > 1 && !steps_.empty()) decays = decay(row).matrix() * decay(row).matrix().transpose();
    state = state.cwiseProduct(decays).eval();
    const Eigen::Matrix<double, kTerms, 1> product = state * amplitudes;
    const double left = variance - amplitudes.dot(product);
    const Eigen::Matrix<double, kTerms, 1> gain = (1.0 - product.array()).matrix() / left;
    deviation_[row] = std::sqrt(left);
    gains_.col(row) = gain;
    state.noalias() += left * gain * gain.transpose();
  }
}

template <int Columns, MixtureFactor::Direction direction>
void MixtureFactor::filter(double* first, Eigen::Index stride) const {
  using Lane = std::array<double, Columns>;
  std::array<Lane, kTerms> memory{};
  Terms decays = decay(0);
  for (Eigen::Index row = 0; row < rows(); ++row) {
    if (!steps_.empty()) decays = decay(row);
    Lane predicted{};
    for (int k = 0; k < kTerms; ++k)
      for (int c = 0; c < Columns; ++c) {
        memory[k][c] *= decays[k];
        predicted[c] += amplitudes_[k] * memory[k][c];
      }
    Lane left;
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
    const double* gain = gains_.data() + row * kTerms;
    for (int k = 0; k < kTerms; ++k)
      for (int c = 0; c < Columns; ++c) memory[k][c] += gain[k] * left[c];
  }
}

template <MixtureFactor::Direction direction>
void MixtureFactor::filter(Eigen::Ref<Eigen::MatrixXd> rows) const {
  constexpr int kMany = 8;  // columns at once keep the processor busy
  Eigen::Index column = 0;
  for (; column + kMany <= rows.cols(); column += kMany)
    filter<kMany, direction>(rows.col(column).data(), rows.outerStride());
  for (; column < rows.cols(); ++column)
    filter<1, direction>(rows.col(column).data(), rows.outerStride());
}

void MixtureFactor::whiten(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (white_)
    rows.array().colwise() /= deviation_;
  else
    filter<Direction::whiten>(rows);
}

void MixtureFactor::colour(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (white_)
    rows.array().colwise() *= deviation_;
  else
    filter<Direction::colour>(rows);
}

double MixtureFactor::log_determinant() const { return 2.0 * deviation_.log().sum(); }

}  // namespace slideway
