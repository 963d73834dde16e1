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

/// The covariance with the noise of one profile only (none: that of the priors alone), weights
/// held.
Eigen::MatrixXd with_noise_of(const Solution& fit, std::optional<std::size_t> profile) {
  std::vector<Noise> noise = fit.noise;
  for (std::size_t i = 0; i < noise.size(); ++i) {
    noise[i].declared = true;
    if (i != profile) noise[i].innovation = 0.0;
  }
  return assess(fit.linear, fit.weights, noise, fit.rank.basis).covariance;
}

std::vector<Source> sources_of(const Solution& fit) {
  const Eigen::MatrixXd priors = with_noise_of(fit, std::nullopt);
  std::vector<Source> out;
  Eigen::MatrixXd rest = fit.uncertainty.covariance - priors;
  for (std::size_t i = 0; i < fit.noise.size(); ++i) {
    const bool declared = fit.noise[i].declared;
    out.push_back({"noise of " + fit.linear.observations[i]->profile->name +
                       (declared ? ", as declared" : ", estimated from the residual"),
                   declared ? EvaluationType::B : EvaluationType::A,
                   with_noise_of(fit, i) - priors});
    rest -= out.back().covariance;
  }
  if (fit.linear.prior_rows.rows() > 0)
    out.push_back({"priors of the problem file", EvaluationType::B, priors});
  if (std::any_of(fit.noise.begin(), fit.noise.end(), [](const Noise& n) { return !n.declared; }))
    out.push_back({"weights that come from the same data", EvaluationType::A, rest});
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
      for (const Source& source : sources) {
        const double variance = (row * source.covariance * row.transpose()).value();
        budget.lines.push_back({source.name, source.type, std::sqrt(std::max(variance, 0.0))});
      }
      if (more)
        budget.lines.push_back({"structure without a name", EvaluationType::A,
                                std::sqrt(more(fit.parameters.jacobian.row(index)))});
      out.push_back(std::move(budget));
    }
  return out;
}

}  // namespace slideway
