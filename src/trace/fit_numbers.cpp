#include "fit_numbers.hpp"

#include <cmath>

#include "slideway/identify/uncertainty.hpp"

namespace slideway {

std::optional<double> holdout_rms_um(const ModelResult& fit) {
  double squares = 0.0;
  int count = 0;
  for (const ResidualSummary& residual : fit.residuals)
    if (residual.role == Role::holdout && residual.rms_um)
      squares += *residual.rms_um * *residual.rms_um, ++count;
  if (count == 0) return std::nullopt;
  return std::sqrt(squares / count);
}

std::vector<FittedParameter> parameters_of(const ModelResult& fit, const std::string& effect) {
  std::vector<FittedParameter> out;
  for (const FittedParameter& parameter : fit.parameters)
    if (parameter.name.starts_with(effect + ".")) out.push_back(parameter);
  return out;
}

double size_in_uncertainties(const ModelResult& fit, const ModelTerm& term) {
  const auto decisive = static_cast<std::size_t>(term.effect->decisive_parameter());
  const FittedParameter* own = fit.find(term.name + "." + term.effect->parameters()[decisive].name);
  if (!own || !own->value || !own->expanded_uncertainty) return INFINITY;
  return coverage_factor(std::nullopt) * std::abs(*own->value) / *own->expanded_uncertainty;
}

double widening_by_bend(const Solution& fit, const ModelTerm& term) {
  const Eigen::MatrixXd& bends = fit.uncertainty.departures.to_laws;
  if (bends.cols() == 0) return 1.0;
  const Eigen::RowVectorXd row = fit.parameters.jacobian.row(term.first_parameter);
  const double whole = std::pow(fit.uncertainty.of(row).standard_uncertainty, 2);
  const double beside = whole - (row * bends).squaredNorm();
  return beside > 0.0 ? std::sqrt(whole / beside) : 1.0;
}

}  // namespace slideway
