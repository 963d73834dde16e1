#include "reported.hpp"

#include <algorithm>
#include <cmath>

namespace slideway {

Reported::Reported(const Solution& solution, const MoreVariance& more)
    : solution_(solution), more_(more) {
  const auto is_declared = [](const Noise& noise) { return noise.declared; };
  if (solution.linear.prior_rows.rows() > solution.linear.curve_rows ||
      std::ranges::any_of(solution.noise, is_declared))
    return;
  most_freedom_ = 0.0;
  for (const Noise& noise : solution.noise) *most_freedom_ += noise.effective_values();
}

Spread Reported::spread(const Eigen::RowVectorXd& row) const {
  Spread out = solution_.uncertainty.of(row);
  if (more_) out.standard_uncertainty = std::hypot(out.standard_uncertainty, std::sqrt(more_(row)));
  if (most_freedom_)
    out.degrees_of_freedom = std::min(out.degrees_of_freedom.value_or(HUGE_VAL), *most_freedom_);
  return out;
}

void Reported::set(double value, const Spread& spread, double unit, QuantityValue& out) {
  out.value = value / unit;
  out.standard_uncertainty = spread.standard_uncertainty / unit;
  out.degrees_of_freedom = spread.degrees_of_freedom;
  out.coverage_factor = coverage_factor(spread.degrees_of_freedom);
  out.expanded_uncertainty = *out.coverage_factor * *out.standard_uncertainty;
}

}  // namespace slideway
