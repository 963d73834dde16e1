#include "outstanding_line.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "slideway/base/units.hpp"
#include "slideway/signal/spectrum.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kNeighbours = 15;  // on either side, for the level of a spectrum
constexpr double kNearly = 1.000001;      // beyond rounding

Eigen::MatrixXd line(Eigen::Index n, double cycles_per_value) {
  Eigen::MatrixXd out(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double angle = 2.0 * kPi * cycles_per_value * static_cast<double>(i);
    out.row(i) << std::cos(angle), std::sin(angle);
  }
  return out;
}

/// Spectral power of the values, of each half of a diameter by itself: what the cut has laid down
/// runs there and back. Of one half if `middle` is 0.
double power(const Eigen::VectorXd& values, Eigen::Index middle, double cycles_per_value) {
  const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * cycles_per_value);
  std::complex<double> phase = 1.0, far = 0.0, near = 0.0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    (i < middle ? far : near) += values[i] * phase;
    phase *= turn;
  }
  return std::norm(far) + std::norm(near);
}

/// Frequency near `frequency` where the power is largest, to a thousandth of a cycle a profile.
double sharpened(const Eigen::VectorXd& values, Eigen::Index middle, double frequency) {
  const auto n = static_cast<double>(values.size());
  for (double step = 0.1; step > 5e-4; step /= 10.0) {
    const double centre = frequency;
    double largest = -1.0;
    for (int i = -10; i <= 10; ++i) {
      const double f = centre + i * step / n, size = power(values, middle, f);
      if (size > largest) largest = size, frequency = f;
    }
  }
  return frequency;
}

}  // namespace

double outstanding_line(const Eigen::VectorXd& values, Eigen::Index middle, double false_line) {
  const Eigen::Index n = values.size(), count = (n - 1) / 2;
  if (count < 4 * kNeighbours) return 0.0;
  const std::vector<double> from_mean = power_spectrum(view(values));
  const Eigen::Map<const Eigen::VectorXd> spectrum(from_mean.data() + 1, count);
  double best = std::log(static_cast<double>(count) / false_line);
  Eigen::Index peak = -1;
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index first =
        std::clamp<Eigen::Index>(k - kNeighbours, 0, count - 2 * kNeighbours - 1);
    const auto neighbours = spectrum.segment(first, 2 * kNeighbours + 1);
    if ((neighbours.array() * best < kNearly * std::log(2.0) * spectrum[k]).count() <= kNeighbours)
      continue;  // their median is larger
    std::vector<double> around(neighbours.begin(), neighbours.end());
    std::nth_element(around.begin(), around.begin() + kNeighbours, around.end());
    const double level = around[kNeighbours] / std::log(2.0);
    if (spectrum[k] > best * level) best = spectrum[k] / level, peak = k;
  }
  if (peak < 0) return 0.0;
  return sharpened(values, middle, static_cast<double>(peak + 1) / static_cast<double>(n));
}

Eigen::MatrixXd line_on(Eigen::Index values, Eigen::Index middle, double cycles_per_value) {
  Eigen::MatrixXd out = line(values, cycles_per_value);
  if (middle == 0) return out;
  out.conservativeResize(Eigen::NoChange, 4);
  out.rightCols(2) = out.leftCols(2);
  out.topRightCorner(middle, 2).setZero();
  return out;
}

}  // namespace slideway
