#pragma once

#include <cmath>
#include <string>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Numbers of a solution as a report has them. Every uncertainty that is reported is made here, so
/// that what widens one widens all.
class Reported {
 public:
  Reported(const Solution& solution, const MoreVariance& more) : solution_(solution), more_(more) {}

  /// Standard uncertainty of row * (amplitudes, shapes), widened, and its degrees of freedom.
  [[nodiscard]] Spread spread(const Eigen::RowVectorXd& row) const {
    Spread out = solution_.uncertainty.of(row);
    if (more_)
      out.standard_uncertainty = std::hypot(out.standard_uncertainty, std::sqrt(more_(row)));
    return out;
  }

  /// Sets value and uncertainty of row * (amplitudes, shapes), both divided by `unit`.
  void set(double value, const Eigen::RowVectorXd& row, double unit, QuantityValue& out) const {
    set(value, spread(row), unit, out);
  }

  static void set(double value, const Spread& spread, double unit, QuantityValue& out) {
    out.value = value / unit;
    out.standard_uncertainty = spread.standard_uncertainty / unit;
    out.degrees_of_freedom = spread.degrees_of_freedom;
    out.coverage_factor = coverage_factor(spread.degrees_of_freedom);
    out.expanded_uncertainty = *out.coverage_factor * *out.standard_uncertainty;
  }

  [[nodiscard]] const Solution& solution() const { return solution_; }
  [[nodiscard]] const MoreVariance& more() const { return more_; }

 private:
  const Solution& solution_;
  const MoreVariance& more_;
};

}  // namespace slideway
