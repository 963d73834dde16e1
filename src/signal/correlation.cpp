#include "slideway/signal/correlation.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <unsupported/Eigen/FFT>

#include "fourier.hpp"
#include "slideway/base/distribution.hpp"
#include "slideway/signal/lagged_products.hpp"
#include "slideway/signal/view.hpp"

namespace slideway {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// A spread no larger than the last digits of the values is a constant's.
bool is_rounding(double squares, double n, double mean) {
  const double last_digits = 4.0 * kEpsilon * mean;
  return squares <= n * last_digits * last_digits;
}

// Sums of squares and products about the means, a block of pairs at a time (Chan, Golub and LeVeque
// 1983). Values count from the first one, so that no digits go to a huge mean and a constant has
// exactly no spread.
class CoMoments {
 public:
  CoMoments(double first_x, double first_y) : first_x_(first_x), first_y_(first_y) {}

  void add(std::span<const double> x, std::span<const double> y) {
    const auto count = static_cast<double>(x.size());
    Eigen::ArrayXd dx = Eigen::Map<const Eigen::ArrayXd>(x.data(), std::ssize(x)) - first_x_;
    Eigen::ArrayXd dy = Eigen::Map<const Eigen::ArrayXd>(y.data(), std::ssize(y)) - first_y_;
    const double mean_x = dx.mean();
    const double mean_y = dy.mean();
    dx -= mean_x;
    dy -= mean_y;
    const double step_x = mean_x - mean_x_;
    const double step_y = mean_y - mean_y_;
    const double share = count / (n_ + count);
    xx_ += dx.square().sum() + n_ * share * step_x * step_x;
    yy_ += dy.square().sum() + n_ * share * step_y * step_y;
    xy_ += (dx * dy).sum() + n_ * share * step_x * step_y;
    mean_x_ += share * step_x;
    mean_y_ += share * step_y;
    n_ += count;
  }

  double coefficient() const {
    if (is_rounding(xx_, n_, first_x_ + mean_x_) || is_rounding(yy_, n_, first_y_ + mean_y_))
      return 0.0;
    return std::clamp(xy_ / std::sqrt(xx_) / std::sqrt(yy_), -1.0, 1.0);
  }

 private:
  double n_ = 0.0;
  double first_x_, first_y_;
  double mean_x_ = 0.0, mean_y_ = 0.0;  // from the first
  double xx_ = 0.0, yy_ = 0.0, xy_ = 0.0;
};

// The same of three series at once: x, y and s, of which a line is taken out of both in the end.
class LevelledMoments {
 public:
  using Matrix = Eigen::Matrix3d;

  explicit LevelledMoments(const Eigen::RowVector3d& first) : first_(first) {}

  void add(std::span<const double> x, std::span<const double> y, std::span<const double> s) {
    const auto count = static_cast<double>(x.size());
    Eigen::Matrix<double, Eigen::Dynamic, 3> d(std::ssize(x), 3);
    for (Eigen::Index j = 0; const auto& series : {x, y, s})
      d.col(j++) = Eigen::Map<const Eigen::VectorXd>(series.data(), std::ssize(series));
    d.rowwise() -= first_;
    const Eigen::RowVector3d mean = d.colwise().mean();
    d.rowwise() -= mean;
    const Eigen::RowVector3d step = mean - mean_;
    const double share = count / (n_ + count);
    products_ += d.transpose() * d + n_ * share * step.transpose() * step;
    mean_ += share * step;
    n_ += count;
  }

  [[nodiscard]] const Matrix& products() const { return products_; }

  // Of the products of a part, with the slopes of the whole.
  static double coefficient(const Matrix& part, const Matrix& whole) {
    constexpr double kNothing = 64.0 * kEpsilon;  // of the square: cancellation, not variation
    const double spread = whole(2, 2);
    Eigen::Matrix<double, 3, 2> take = Eigen::Matrix<double, 3, 2>::Identity();
    if (spread > 0.0) take.row(2) = -whole.block<1, 2>(2, 0) / spread;
    const Eigen::Matrix2d left = take.transpose() * part * take;
    if (left(0, 0) <= kNothing * whole(0, 0) || left(1, 1) <= kNothing * whole(1, 1)) return 0.0;
    return std::clamp(left(0, 1) / std::sqrt(left(0, 0)) / std::sqrt(left(1, 1)), -1.0, 1.0);
  }

 private:
  double n_ = 0.0;
  Eigen::RowVector3d first_, mean_ = Eigen::RowVector3d::Zero();  // the mean from the first
  Matrix products_ = Matrix::Zero();
};

// Makes y a part at a time up to each of `points` places and tells where it stands: of the samples
// that make a part, add(first, y); of each place, mark(samples).
template <typename Add, typename Mark>
void in_parts(std::size_t size, const FillSeries& fill, std::size_t points, Add&& add,
              Mark&& mark) {
  constexpr std::size_t kBlock = 4096;  // pairs that stay in the cache
  points = std::min(points, size);
  std::vector<double> y;
  std::size_t done = 0;
  for (std::size_t k = 1; k <= points; ++k) {
    for (const std::size_t end = k * size / points; done < end; done += y.size()) {
      y.resize(std::min(kBlock, end - done));
      fill(done, y);
      add(done, y);
    }
    mark(done);
  }
}

// The series about its mean; all zeros for a constant.
Eigen::VectorXd centred(std::span<const double> x) {
  if (x.empty()) return {};
  Eigen::VectorXd d =
      Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x)).array() - x.front();
  const double offset = d.mean();
  d.array() -= offset;
  if (is_rounding(d.squaredNorm(), static_cast<double>(d.size()), x.front() + offset)) d.setZero();
  return d;
}

// Running sums of d and of d^2: [i] is over the first i samples.
struct RunningSums {
  explicit RunningSums(const Eigen::VectorXd& d) : sum(d.size() + 1), squares(d.size() + 1) {
    sum[0] = squares[0] = 0.0;
    for (Eigen::Index i = 0; i < d.size(); ++i) {
      sum[i + 1] = sum[i] + d[i];
      squares[i + 1] = squares[i] + d[i] * d[i];
    }
  }
  Eigen::VectorXd sum, squares;
};

// Means of so many values each; of what is left at the end there is none.
Eigen::VectorXd means(const Eigen::VectorXd& x, Eigen::Index block) {
  if (block == 1) return x;
  const Eigen::Index count = x.size() / block;
  return x.head(count * block).reshaped(block, count).colwise().mean().transpose();
}

// Σ_t d_t d_(t+k) of two series at once for every k, by the fast Fourier transform: the real part
// of the result is of x, the imaginary part of y.
std::vector<std::complex<double>> all_lagged_products(const Eigen::VectorXd& x,
                                                      const Eigen::VectorXd& y) {
  const std::size_t size = fast_length(2 * static_cast<std::size_t>(x.size()));
  std::vector<std::complex<double>> signal(size);
  std::vector<std::complex<double>> spectrum(size);
  for (Eigen::Index t = 0; t < x.size(); ++t) signal[t] = {x[t], y[t]};
  Eigen::FFT<double> fft;
  fft.fwd(spectrum, signal);
  for (std::size_t f = 0; f < size; ++f) {
    const std::complex<double> mirrored = std::conj(spectrum[(size - f) % size]);
    signal[f] = {std::norm(spectrum[f] + mirrored) / 4.0, std::norm(spectrum[f] - mirrored) / 4.0};
  }
  fft.inv(spectrum, signal);
  return spectrum;
}

}  // namespace

double pearson(std::span<const double> x, std::span<const double> y) {
  const Eigen::VectorXd dx = centred(x);
  const Eigen::VectorXd dy = centred(y);
  const double scale = dx.norm() * dy.norm();
  return scale > 0.0 ? std::clamp(dx.dot(dy) / scale, -1.0, 1.0) : 0.0;
}

RunningCoefficient running_pearson(std::span<const double> x, std::span<const double> y,
                                   std::size_t points) {
  const auto copy = [y](std::size_t first, std::span<double> part) {
    std::ranges::copy(y.subspan(first, part.size()), part.begin());
  };
  return running_pearson(x, copy, points);
}

RunningCoefficient running_pearson(std::span<const double> x, const FillSeries& fill,
                                   std::size_t points) {
  RunningCoefficient running;
  std::optional<CoMoments> moments;
  in_parts(
      x.size(), fill, points,
      [&](std::size_t first, std::span<const double> y) {
        if (!moments) moments.emplace(x.front(), y.front());
        moments->add(x.subspan(first, y.size()), y);
      },
      [&](std::size_t samples) {
        running.samples.push_back(samples);
        running.coefficient.push_back(moments->coefficient());
      });
  return running;
}

RunningCoefficient running_pearson(std::span<const double> x, const FillSeries& fill,
                                   std::size_t points, std::span<const double> along) {
  RunningCoefficient running;
  std::optional<LevelledMoments> moments;
  std::vector<LevelledMoments::Matrix> products;
  in_parts(
      x.size(), fill, points,
      [&](std::size_t first, std::span<const double> y) {
        if (!moments) moments.emplace(Eigen::RowVector3d(x.front(), y.front(), along.front()));
        moments->add(x.subspan(first, y.size()), y, along.subspan(first, y.size()));
      },
      [&](std::size_t samples) {
        running.samples.push_back(samples);
        products.push_back(moments->products());
      });
  for (const LevelledMoments::Matrix& part : products)
    running.coefficient.push_back(LevelledMoments::coefficient(part, products.back()));
  return running;
}

Lag best_lag(std::span<const double> x, std::span<const double> y, int max_lag) {
  const Eigen::VectorXd dx = centred(x);
  const Eigen::VectorXd dy = centred(y);
  const Eigen::Index n = dx.size();
  const RunningSums x_sums(dx);
  const RunningSums y_sums(dy);
  constexpr double kNothing = 1e-12;  // of the whole: cancellation, not variation
  if (n < 3) return {};
  const Eigen::Index most = std::min<Eigen::Index>(max_lag, n - 3);
  const std::vector<double> products =
      lagged_products(view(dx), view(dy), -most, static_cast<std::size_t>(2 * most + 1));

  const auto coefficient = [&](Eigen::Index lag) {
    const Eigen::Index size = n - std::abs(lag);
    const Eigen::Index from_x = std::max<Eigen::Index>(0, -lag);
    const Eigen::Index from_y = std::max<Eigen::Index>(0, lag);
    const auto count = static_cast<double>(size);
    const double sum_x = x_sums.sum[from_x + size] - x_sums.sum[from_x];
    const double sum_y = y_sums.sum[from_y + size] - y_sums.sum[from_y];
    const double xx =
        x_sums.squares[from_x + size] - x_sums.squares[from_x] - sum_x * sum_x / count;
    const double yy =
        y_sums.squares[from_y + size] - y_sums.squares[from_y] - sum_y * sum_y / count;
    if (xx <= kNothing * x_sums.squares[n] || yy <= kNothing * y_sums.squares[n]) return 0.0;
    return std::clamp(
        (products[lag + most] - sum_x * sum_y / count) / std::sqrt(xx) / std::sqrt(yy), -1.0, 1.0);
  };

  Lag best{0, coefficient(0)};
  for (int lag = 1; lag <= most; ++lag)
    for (const int signed_lag : {lag, -lag}) {
      const double r = coefficient(signed_lag);
      if (std::abs(r) > std::abs(best.coefficient) + kNothing) best = {signed_lag, r};
    }
  return best;
}

std::vector<double> autocorrelation(std::span<const double> x, int max_lag) {
  const Eigen::VectorXd d = centred(x);
  std::vector<double> r(static_cast<std::size_t>(max_lag) + 1, 0.0);
  r[0] = 1.0;
  const double variance = d.squaredNorm();
  const std::size_t lags = std::min(r.size(), x.size());
  if (!(variance > 0.0)) return r;
  const std::vector<double> products = lagged_products(view(d), view(d), 0, lags);
  for (std::size_t k = 1; k < lags; ++k) r[k] = products[k] / variance;
  return r;
}

double effective_observations(std::span<const double> x, std::span<const double> y) {
  constexpr Eigen::Index kDirect = 36, kAtOnce = 8;  // few lags are cheaper than a transform
  constexpr Eigen::Index kLong = 1 << 14, kMeans = 8;
  const Eigen::VectorXd dx = centred(x);
  const Eigen::VectorXd dy = centred(y);
  const double scale = dx.squaredNorm() * dy.squaredNorm();
  const auto n = static_cast<double>(dx.size());
  double sum = 0.0;
  // Adds what so many lags about this one have; false where the sum is cut.
  const auto add = [&](Eigen::Index lag, Eigen::Index lags, double product) {
    if (product <= 0.0) return false;
    sum += static_cast<double>(lags) * (1.0 - static_cast<double>(lag) / n) * product / scale;
    return true;
  };
  bool goes_on = scale > 0.0;
  std::vector<double> some_x, some_y;
  for (Eigen::Index k = 1; goes_on && k <= std::min(kDirect, dx.size() - 1); ++k) {
    const Eigen::Index i = (k - 1) % kAtOnce;
    if (i == 0) {
      some_x = lagged_products(view(dx), view(dx), k, kAtOnce);
      some_y = lagged_products(view(dy), view(dy), k, kAtOnce);
    }
    goes_on = add(k, 1, some_x[i] * some_y[i]);
  }
  if (goes_on && dx.size() > kDirect + 1) {
    const Eigen::Index block = dx.size() > kLong ? kMeans : 1;
    const Eigen::VectorXd mean_x = means(dx, block), mean_y = means(dy, block);
    const std::vector<std::complex<double>> all = all_lagged_products(mean_x, mean_y);
    // As many products of means are so much fewer than those of the values.
    const auto squares = static_cast<double>(block * block);
    for (Eigen::Index k = kDirect / block + 1; goes_on && k < mean_x.size(); ++k)
      goes_on = add(k * block, block, squares * all[k].real() * all[k].imag());
  }
  return std::clamp(n / (1.0 + 2.0 * sum), std::min(3.0, n), n);
}

double correlation_p_value(double r, double n) {
  if (n <= 2.0) return 1.0;
  // With t^2 = r^2 (n - 2) / (1 - r^2) Student's two tails are an incomplete beta function of
  // 1 - r^2.
  const double rest = (1.0 - r) * (1.0 + r);
  return rest > 0.0 ? beta_share(0.5 * (n - 2.0), 0.5, std::min(rest, 1.0)) : 0.0;
}

double ljung_box_p_value(std::span<const double> series, int lags, int fitted) {
  const auto n = static_cast<double>(series.size());
  const std::vector<double> r = autocorrelation(series, lags);
  double sum = 0.0;
  for (int k = 1; k <= lags && k < std::ssize(series); ++k)
    sum += r[static_cast<std::size_t>(k)] * r[static_cast<std::size_t>(k)] / (n - k);
  const double freedom = std::max(lags - fitted, 1);
  return chi_squared_tail(freedom, n * (n + 2.0) * sum);
}

}  // namespace slideway
