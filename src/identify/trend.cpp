#include "trend.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "slideway/base/distribution.hpp"
#include "slideway/identify/uncertainty.hpp"

namespace slideway {
namespace {

struct TrendLine {
  Eigen::Vector2d coefficients;
  Eigen::Matrix2d covariance;
  double chi_square = 0.0;
};

TrendLine fit_line(const Eigen::MatrixX2d& columns, const Eigen::VectorXd& values,
                   const Eigen::VectorXd& weights) {
  TrendLine line;
  line.covariance = (columns.transpose() * weights.asDiagonal() * columns).inverse();
  line.coefficients = line.covariance * (columns.transpose() * (weights.cwiseProduct(values)));
  const Eigen::VectorXd residual = values - columns * line.coefficients;
  line.chi_square = residual.cwiseAbs2().dot(weights);
  return line;
}

/// τ²: what the residual has beyond its expectation at τ = 0.
double variance_between(const TrendLine& line, const Eigen::MatrixX2d& columns,
                        const Eigen::VectorXd& weights) {
  const Eigen::Matrix2d squares = columns.transpose() * weights.cwiseAbs2().asDiagonal() * columns;
  const auto expected = static_cast<double>(columns.rows() - 2);
  return std::max(
      0.0, (line.chi_square - expected) / (weights.sum() - (line.covariance * squares).trace()));
}

}  // namespace

std::vector<Trend> trends(const std::vector<std::vector<FittedParameter>>& items,
                          const std::vector<double>& times) {
  std::vector<Trend> out;
  for (std::size_t p = 0; !items.empty() && p < items.front().size(); ++p) {
    std::vector<std::size_t> known;
    for (std::size_t i = 0; i < items.size(); ++i)
      if (items[i][p].identifiable && *items[i][p].standard_uncertainty > 0.0) known.push_back(i);
    const auto n = static_cast<Eigen::Index>(known.size());
    if (n < 3) continue;
    Eigen::MatrixX2d columns(n, 2);
    Eigen::VectorXd values(n), variances(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      columns.row(i) << 1.0, times[known[i]];
      values[i] = *items[known[i]][p].value;
      variances[i] = std::pow(*items[known[i]][p].standard_uncertainty, 2);
    }
    columns.col(1).array() -= columns.col(1).mean();
    const double span = columns.col(1).cwiseAbs().maxCoeff();
    if (!(span > 0.0)) continue;
    columns.col(1) /= span;
    const double unit = std::sqrt(variances.minCoeff());  // small numbers squared stay numbers
    values /= unit;
    variances /= unit * unit;

    const Eigen::VectorXd weights = variances.cwiseInverse();
    const double between = variance_between(fit_line(columns, values, weights), columns, weights);
    const TrendLine line = fit_line(columns, values, (variances.array() + between).inverse());
    const double excess = std::max(1.0, line.chi_square / static_cast<double>(n - 2));
    Trend trend{items.front()[p].name, items.front()[p].unit, known.size()};
    trend.rate = line.coefficients[1] * unit / span;
    trend.standard_uncertainty = std::sqrt(line.covariance(1, 1) * excess) * unit / span;
    // One item may outweigh the others beyond the digits of a double.
    if (!std::isfinite(trend.rate) || !(trend.standard_uncertainty > 0.0)) continue;
    const auto freedom = static_cast<double>(n - 2);
    trend.expanded_uncertainty = coverage_factor(freedom) * trend.standard_uncertainty;
    trend.p_value = 2.0 * student_tail(freedom, std::abs(trend.rate / trend.standard_uncertainty));
    trend.between_items = std::sqrt(between) * unit;
    out.push_back(std::move(trend));
  }
  return out;
}

}  // namespace slideway
