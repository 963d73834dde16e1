#include "slideway/identify/budget.hpp"

#include <algorithm>
#include <cmath>

namespace slideway {
namespace {

struct Source {
  std::string name;
  EvaluationType type;
  Eigen::MatrixXd covariance;  // of w
};

/// In coordinates in which all information is the unit matrix the information of a source is also
/// its part of the covariance. That of the noise's own uncertainty may be negative, where the mean
/// over the noises that the data allow is smaller: the sources before it share it in proportion.
std::vector<Source> sources_of(const Solution& fit) {
  const Eigen::Index r = fit.rank.basis.cols();
  std::vector<Source> out;
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const bool declared = fit.noise[i].declared;
    out.push_back({"noise of " + fit.linear.observations[i]->profile->name +
                       (declared ? ", as declared" : ", estimated from the residual"),
                   declared ? EvaluationType::type_b : EvaluationType::type_a,
                   fit.uncertainty.information[i]});
  }
  const Eigen::MatrixXd rows = fit.linear.prior_rows * fit.rank.basis;
  const Eigen::Index curve = fit.linear.curve_rows, declared = rows.rows() - curve;
  if (declared > 0)
    out.push_back({"priors of the problem file", EvaluationType::type_b,
                   rows.topRows(declared).transpose() * rows.topRows(declared)});
  if (curve > 0)
    out.push_back({"what the curve does between the readings", EvaluationType::type_a,
                   rows.bottomRows(curve).transpose() * rows.bottomRows(curve)});
  if (curve > 0 || std::ranges::any_of(fit.noise, &Noise::is_estimated))
    out.push_back({curve > 0 ? "noise and prior of the curve, that come from the same data"
                             : "noise that comes from the same data",
                   EvaluationType::type_a,
                   fit.uncertainty.covariance - Eigen::MatrixXd::Identity(r, r)});
  if (const double inflation = fit.uncertainty.inflation; inflation > 1.0)
    out.push_back({"structure the model lacks", EvaluationType::type_a,
                   (inflation - 1.0) * fit.uncertainty.covariance});
  return out;
}

}  // namespace

std::vector<Budget> uncertainty_budget(const Model& model, const Solution& fit,
                                       const MoreVariance& more) {
  const std::vector<Source> sources = sources_of(fit);
  std::vector<Budget> out;
  for (const ModelTerm& term : model.terms)
    for (std::size_t p = 0; p < term.effect->parameters().size(); ++p) {
      const Eigen::Index index = term.first_parameter + static_cast<Eigen::Index>(p);
      if (!fit.null.identifiable[index]) continue;
      const Parameter& parameter = term.effect->parameters()[p];
      const Eigen::RowVectorXd row = fit.parameters.jacobian.row(index) * fit.uncertainty.basis;
      Budget budget{term.name + "." + parameter.name, parameter.unit, {}};
      double sum = 0.0;
      for (const Source& source : sources) {
        const double variance = (row * source.covariance * row.transpose()).value();
        if (variance < 0.0 && sum > 0.0)
          for (BudgetLine& line : budget.lines)
            line.standard_uncertainty *= std::sqrt(std::max(1.0 + variance / sum, 0.0));
        budget.lines.push_back({source.name, source.type, std::sqrt(std::max(variance, 0.0))});
        sum += variance;
      }
      if (more)
        budget.lines.push_back({"other explanations", EvaluationType::type_a,
                                std::sqrt(more(fit.parameters.jacobian.row(index)))});
      out.push_back(std::move(budget));
    }
  return out;
}

}  // namespace slideway
