#include "slideway/signal/exponential_mixture.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "slideway/base/units.hpp"
#include "slideway/base/wide.hpp"

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
    : MixtureFactor(noise, std::vector<double>{}, n) {}

MixtureFactor::MixtureFactor(const ExponentialMixture& noise, std::span<const double> stations)
    : MixtureFactor(noise, steps_between(stations), std::ssize(stations)) {}

MixtureFactor::MixtureFactor(const ExponentialMixture& noise, std::vector<double> steps,
                             Eigen::Index n)
    : steps_(std::move(steps)),
      rates_(noise.lengths.inverse()),
      amplitudes_(continued(noise)),
      deviation_(n) {
  const double variance = noise.variance();
  const Eigen::Index terms = (noise.variances != 0.0).count();
  if (terms == 0) {
    deviation_.setConstant(std::sqrt(variance));
  } else if (terms == 1) {
    Eigen::Index which = 0;
    amplitudes_.maxCoeff(&which);
    rates_[0] = rates_[which];
    amplitudes_[0] = amplitudes_[which];
    factorise<1>(variance);
  } else {
    factorise<kTerms>(variance);
  }
}

Terms MixtureFactor::decay(Eigen::Index row) const {
  return (-(steps_.empty() ? 1.0 : steps_[static_cast<std::size_t>(row)]) * rates_).exp();
}

template <int Count>
void MixtureFactor::factorise(double variance) {
  count_ = Count;
  gains_.resize(static_cast<std::size_t>(rows() * Count));
  using Square = Eigen::Matrix<double, Count, Count>;
  using Vector = Eigen::Matrix<double, Count, 1>;
  const Vector amplitudes = amplitudes_.head<Count>();
  Square state = Square::Zero(), decays = Square::Zero();
  for (Eigen::Index row = 0; row < rows(); ++row) {
    if (row == 0 || !steps_.empty()) {
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
  }
}

template <int Count, int Columns, MixtureFactor::Direction direction>
void MixtureFactor::filter(double* first, Eigen::Index stride) const {
  using Lane = std::array<double, Columns>;
  std::array<Lane, Count> memory{};
  Terms decays = decay(0);
  const double* gain = gains_.data();
  for (Eigen::Index row = 0; row < rows(); ++row, gain += Count) {
    if (!steps_.empty()) decays = decay(row);
    Lane predicted{}, left;
    for (int k = 0; k < Count; ++k)
      for (int c = 0; c < Columns; ++c) {
        memory[k][c] *= decays[k];
        predicted[c] += amplitudes_[k] * memory[k][c];
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
  constexpr int kMany = 8;  // columns at once keep the processor busy
  const Eigen::Index whole = rows.cols() / kMany * kMany;
  wide([&] {
    for (Eigen::Index column = 0; column < whole; column += kMany)
      filter<Count, kMany, direction>(rows.col(column).data(), rows.outerStride());
  });
  for (Eigen::Index column = whole; column < rows.cols(); ++column)
    filter<Count, 1, direction>(rows.col(column).data(), rows.outerStride());
}

template <MixtureFactor::Direction direction>
void MixtureFactor::filter_all(Eigen::Ref<Eigen::MatrixXd> rows) const {
  if (count_ == 1)
    filter<1, direction>(rows);
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
