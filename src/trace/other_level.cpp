#include "slideway/identify/other_level.hpp"

#include "ballot.hpp"
#include "dictionary.hpp"
#include "other_level.hpp"
#include "search.hpp"
#include "slideway/identify/noise_model.hpp"
#include "undescribed.hpp"

namespace slideway {
namespace {

constexpr Eigen::Index kLeastValues = 32;  // of a profile: a noise can be told from them

/// The estimate of another level at this one: nuisances are those of these values.
Solution at_level(const Model& model, const Estimate& estimate) {
  Solution out;
  out.estimate = estimate;
  out.estimate.nuisances.clear();
  for (const Observation* each : fitted_observations(model))
    out.estimate.nuisances.push_back(
        fitted_nuisances(*each, each->values - model_values(model, *each, estimate)));
  out.linear = linearise(model, out.estimate);
  return out;
}

std::string chosen_in(const Model& model, const Estimate& estimate, const SearchRound& round,
                      const TestedCandidate& effect) {
  const Solution fit = at_level(model, estimate);
  const Eigen::Index priors = fit.linear.prior_rows.rows();
  const auto columns_of = [&](const TestedCandidate& each) {
    return stacked_columns(model, each.refined.candidate->term, each.refined.shape, priors);
  };
  const Eigen::MatrixXd own_columns = columns_of(effect);
  Eigen::VectorXd steep;
  if (effect.refined.candidate->term.effect->description().steep_at_centre)
    steep = own_columns * effect.refined.projection.amplitudes;
  const std::vector<Noise> noise =
      noise_beside(fit.linear, model.gates, by_profile(fit.linear, own_columns));
  const Whitened data(fit.linear, noise, undescribed_beside(model, fit, noise, steep));
  Ballot ballot(effect.name());
  for (const TestedCandidate& each : round.tested) {
    if (!each.is_possible()) continue;
    const Projection own = project(data, &each == &effect ? own_columns : columns_of(each));
    if (own.rank > 0)
      ballot.add(each.name(), penalty(data, *each.refined.candidate, own.rank) - own.gain);
  }
  return ballot.chosen(model.gates.tie_bic);
}

}  // namespace

std::vector<std::string> chosen_at_other_levels(const FittedModel& fitted, const SearchRound& round,
                                                const TestedCandidate& effect) {
  std::vector<std::string> out;
  for (const int by : {1, -1})
    if (const std::optional<Model> other = at_other_level(fitted.model, by, kLeastValues))
      out.push_back(chosen_in(*other, fitted.fit.estimate, round, effect));
  return out;
}

}  // namespace slideway
