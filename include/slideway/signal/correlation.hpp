#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace slideway {

/// Pearson's coefficient, Eq. (6); 0 if x or y is constant.
/// REQUIRES x.size() == y.size().
double pearson(std::span<const double> x, std::span<const double> y);

/// The coefficient over the first n samples as n grows (Figs. 8, 9), at `points` values of n spread
/// evenly up to N. REQUIRES x.size() == y.size().
struct RunningCoefficient {
  std::vector<std::size_t> samples;
  std::vector<double> coefficient;
};
RunningCoefficient running_pearson(std::span<const double> x, std::span<const double> y,
                                   std::size_t points);

/// running_pearson() with y computed by `fill` in parts, in order, from sample `first` on.
using FillSeries = std::function<void(std::size_t first, std::span<double> part)>;
RunningCoefficient running_pearson(std::span<const double> x, const FillSeries& fill,
                                   std::size_t points);

/// The same of what a straight line in `along` leaves of both: its slope by least squares over all
/// samples. REQUIRES along.size() == x.size().
RunningCoefficient running_pearson(std::span<const double> x, const FillSeries& fill,
                                   std::size_t points, std::span<const double> along);

/// Lag (in samples, positive if y comes later than x) within ±max_lag at which |Pearson| over the
/// overlap is largest, and that coefficient. The smaller |lag| wins a tie.
struct Lag {
  int lag = 0;
  double coefficient = 0.0;
};
Lag best_lag(std::span<const double> x, std::span<const double> y, int max_lag);

/// Autocorrelation r_0 = 1, r_1 ... r_max_lag of a series (biased estimator, mean removed).
std::vector<double> autocorrelation(std::span<const double> x, int max_lag);

/// Effective number of observations for the correlation of x and y,
///   N / (1 + 2 Σ_k (1 - k/N) r_x(k) r_y(k))   (Bartlett),
/// with the sum truncated at the first lag whose product is not positive; between 3 and N. For more
/// than 16,384 values, lags beyond 36 use means of 8.
double effective_observations(std::span<const double> x, std::span<const double> y);

/// Two-sided p-value of a correlation coefficient r on n (effective) observations, Student's t with
/// n - 2 degrees of freedom.
double correlation_p_value(double r, double n);

/// Ljung-Box p-value of a series for whiteness over `lags` lags, `fitted` parameters subtracted.
double ljung_box_p_value(std::span<const double> series, int lags, int fitted);

}  // namespace slideway
