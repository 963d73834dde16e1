#include "slideway/signal/autoregression.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "slideway/base/distribution.hpp"
#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"
#include "slideway/signal/correlation.hpp"

namespace slideway {

Autoregression::Autoregression(std::vector<double> partial_autocorrelations)
    : partial_(std::move(partial_autocorrelations)),
      predictors_(partial_.size() + 1),
      relative_variance_(partial_.size() + 1, 1.0) {
  for (std::size_t m = 1; m <= partial_.size(); ++m) {
    const double partial = partial_[m - 1];
    if (!(std::abs(partial) < 1.0))
      throw UsageError("autoregression: partial autocorrelation " + shortest(partial) + " of lag " +
                       std::to_string(m) + "; accepted: between -1 and 1");
    const std::vector<double>& shorter = predictors_[m - 1];
    std::vector<double>& longer = predictors_[m];
    for (std::size_t j = 0; j + 1 < m; ++j)
      longer.push_back(shorter[j] - partial * shorter[m - 2 - j]);
    longer.push_back(partial);
  }
  for (std::size_t m = partial_.size(); m > 0; --m) {
    const double kept = (1.0 - partial_[m - 1]) * (1.0 + partial_[m - 1]);
    relative_variance_[m - 1] = relative_variance_[m] / kept;
  }
}

std::span<const double> Autoregression::predictor(int m) const {
  return predictors_[static_cast<std::size_t>(m)];
}

double Autoregression::relative_variance(int m) const {
  return relative_variance_[static_cast<std::size_t>(m)];
}

std::vector<double> Autoregression::autocorrelation(int max_lag) const {
  std::vector<double> rho{1.0};
  for (int lag = 1; lag <= max_lag; ++lag) {  // Yule-Walker, which each lower order obeys too
    double sum = 0.0;
    auto before = rho.rbegin();
    for (const double phi : predictor(std::min(lag, order()))) sum += phi * *before++;
    rho.push_back(sum);
  }
  return rho;
}

double Autoregression::long_run_ratio() const {
  double gain = 1.0;
  for (const double phi : predictor(order())) gain -= phi;
  return 1.0 / (gain * gain * variance_ratio());
}

void Autoregression::whiten(Eigen::Ref<Eigen::MatrixXd> rows) const {
  const Eigen::Index p = order(), started = std::min<Eigen::Index>(p, rows.rows());
  const Eigen::Index rest = rows.rows() - started;
  std::vector<double> copy(static_cast<std::size_t>(rows.rows()));
  const Eigen::Map<Eigen::VectorXd> raw(copy.data(), rows.rows());
  for (Eigen::Index column = 0; column < rows.cols(); ++column) {
    auto e = rows.col(column);
    std::copy(e.begin(), e.end(), copy.begin());
    for (Eigen::Index t = 0; t < started; ++t) {
      const int m = static_cast<int>(t);
      const std::span<const double> phi = predictor(m);
      for (Eigen::Index k = 0; k < t; ++k) e[t] -= phi[k] * raw[t - 1 - k];
      e[t] /= std::sqrt(relative_variance(m));
    }
    for (Eigen::Index k = 0; k < p && rest > 0; ++k)
      e.tail(rest) -= predictor(static_cast<int>(p))[k] * raw.segment(p - 1 - k, rest);
  }
}

void Autoregression::colour(Eigen::Ref<Eigen::MatrixXd> rows) const {
  for (Eigen::Index column = 0; column < rows.cols(); ++column) {
    double* e = rows.col(column).data();
    for (Eigen::Index t = 0; t < rows.rows(); ++t) {
      const int m = static_cast<int>(std::min<Eigen::Index>(t, order()));
      const double* before = e + t;
      if (m < order()) e[t] *= std::sqrt(relative_variance(m));
      for (const double phi : predictor(m)) e[t] += phi * *--before;
    }
  }
}

double Autoregression::log_determinant(Eigen::Index n) const {
  double sum = 0.0;
  for (int m = 0; m < std::min<Eigen::Index>(n, order()); ++m)
    sum += std::log(relative_variance(m));
  return sum;
}

std::vector<double> Autoregression::burg(std::span<const double> series, int p) {
  constexpr double kMost = 0.995;
  std::vector<double> forward(series.begin(), series.end());
  std::vector<double> backward = forward;
  std::vector<double> partial(static_cast<std::size_t>(p), 0.0);
  for (std::size_t m = 1; m <= partial.size() && m < series.size(); ++m) {
    double product = 0.0;
    double power = 0.0;
    for (std::size_t t = m; t < series.size(); ++t) {
      product += forward[t] * backward[t - 1];
      power += forward[t] * forward[t] + backward[t - 1] * backward[t - 1];
    }
    if (power <= 0.0) break;
    const double k = std::clamp(2.0 * product / power, -kMost, kMost);
    partial[m - 1] = k;
    for (std::size_t t = series.size() - 1; t >= m; --t) {
      const double ahead = forward[t];
      forward[t] = ahead - k * backward[t - 1];
      backward[t] = backward[t - 1] - k * ahead;
    }
  }
  return partial;
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
