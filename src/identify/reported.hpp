#pragma once

#include <optional>

#include "slideway/identify/fit.hpp"

namespace slideway {

/// Numbers of a solution as a report has them. Every uncertainty that is reported is made here, so
/// that what widens one widens all.
class Reported {
 public:
  /// Both must outlive it.
  Reported(const Solution& solution, const MoreVariance& more);

  /// Standard uncertainty of row * (amplitudes, shapes), widened, and its degrees of freedom: where
  /// all that is known of the noise comes from the residual, no more than effective values.
  [[nodiscard]] Spread spread(const Eigen::RowVectorXd& row) const;

  /// Sets value and uncertainty of row * (amplitudes, shapes), both divided by `unit`.
  void set(double value, const Eigen::RowVectorXd& row, double unit, QuantityValue& out) const {
    set(value, spread(row), unit, out);
  }
  static void set(double value, const Spread& spread, double unit, QuantityValue& out);

  [[nodiscard]] const Solution& solution() const { return solution_; }

 private:
  const Solution& solution_;
  const MoreVariance& more_;
  std::optional<double> most_freedom_;
};

}  // namespace slideway
