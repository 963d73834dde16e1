#include "slideway/signal/octave_powers.hpp"

#include <cmath>

#include "slideway/base/units.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kSegment = 64, kKept = kSegment / 2;
using Cosines = Eigen::Matrix<double, kKept, kSegment>;

Cosines upper_cosines() {
  Cosines out;
  for (Eigen::Index j = 0; j < kKept; ++j)
    for (Eigen::Index s = 0; s < kSegment; ++s)
      out(j, s) = std::sqrt(2.0 / kSegment) * std::cos(kPi * static_cast<double>(j + kKept) *
                                                       (static_cast<double>(s) + 0.5) / kSegment);
  return out;
}

const Cosines& cosines() {
  static const Cosines kCosines = upper_cosines();
  return kCosines;
}

/// Variance of each cosine of noise with the covariance ρ^d from the distance 1 on, and 0 at 0.
Eigen::ArrayXd beyond_itself(double rho) {
  using Column = Eigen::Array<double, kKept, 1>;
  Column so_far = Column::Zero(), sum = Column::Zero();
  for (Eigen::Index s = 1; s < kSegment; ++s) {
    so_far = rho * (so_far + cosines().col(s - 1).array());
    sum += so_far * cosines().col(s).array();
  }
  return 2.0 * sum;
}

Eigen::ArrayXd variances(const ExponentialMixture& noise) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Constant(kKept, noise.variance());
  const ExponentialMixture::Terms alone = noise.continued();
  for (int k = 0; k < ExponentialMixture::kTerms; ++k)
    if (alone[k] != 0.0) out += alone[k] * beyond_itself(std::exp(-1.0 / noise.lengths[k]));
  return out;
}

/// Means of pairs of neighbours in each run, one run after the other, with the new runs.
Eigen::VectorXd halved(const Eigen::VectorXd& series, std::vector<Run>& runs) {
  Eigen::Index all = 0;
  for (const auto& [first, count] : runs) all += count / 2;
  Eigen::VectorXd out(all);
  Eigen::Index next = 0;
  for (auto& [first, count] : runs) {
    for (Eigen::Index i = 0; i < count / 2; ++i)
      out[next + i] = 0.5 * (series[first + 2 * i] + series[first + 2 * i + 1]);
    first = next;
    count /= 2;
    next += count;
  }
  return out;
}

}  // namespace

Eigen::MatrixXd block_means(const Eigen::MatrixXd& rows, const std::vector<Run>& runs,
                            int octaves) {
  const Eigen::Index size = Eigen::Index{1} << octaves;
  Eigen::Index all = 0;
  for (const auto& [first, count] : runs) all += count / size;
  Eigen::MatrixXd out(all, rows.cols());
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    Eigen::Index next = 0;
    for (const auto& [first, count] : runs)
      for (Eigen::Index i = 0; i < count / size; ++i)
        out(next++, j) = rows.col(j).segment(first + i * size, size).mean();
  }
  return out;
}

OctavePowers::OctavePowers(const Eigen::VectorXd& series, const std::vector<Run>& runs,
                           int octaves) {
  constexpr Eigen::Index kAtOnce = 128;  // segments: their cosines stay in the cache
  Eigen::VectorXd left = series;
  std::vector<Run> parts = runs;
  for (int stage = 0; stage < octaves; ++stage) {
    Octave octave{Eigen::ArrayXd::Zero(kKept)};
    for (const auto& [first, count] : parts) {
      const Eigen::Map<const Eigen::Matrix<double, kSegment, Eigen::Dynamic>> segments(
          left.data() + first, kSegment, count / kSegment);
      for (Eigen::Index from = 0; from < segments.cols(); from += kAtOnce) {
        const Eigen::Index taken = std::min(kAtOnce, segments.cols() - from);
        octave.mean_square +=
            (cosines() * segments.middleCols(from, taken)).rowwise().squaredNorm().array();
      }
      octave.segments += static_cast<double>(segments.cols());
    }
    if (octave.segments > 0.0) {
      octave.mean_square /= octave.segments;
      octaves_.push_back(std::move(octave));
    }
    left = halved(left, parts);
  }
}

OctavePowers::Fit OctavePowers::under(const ExponentialMixture& noise) const {
  Fit out;
  ExponentialMixture of_means = noise;
  for (const Octave& octave : octaves_) {
    const Eigen::ArrayXd f = variances(of_means);
    out.log_determinant += octave.segments * f.log().sum();
    out.square += octave.segments * (octave.mean_square / f).sum();
    of_means = of_means.of_means(2.0);
  }
  return out;
}

double OctavePowers::count() const {
  double out = 0.0;
  for (const Octave& octave : octaves_) out += octave.segments * static_cast<double>(kKept);
  return out;
}

}  // namespace slideway
