#include "rests_on.hpp"

#include <algorithm>
#include <numeric>

#include "readings.hpp"
#include "search.hpp"

namespace slideway {
namespace {

FreeValues all_of_slides(const Linearisation& linear) {
  FreeValues out(linear.observations.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!reads_slide(linear.observations[i])) continue;
    out[i].resize(static_cast<std::size_t>(linear.observations[i]->values.size()));
    std::iota(out[i].begin(), out[i].end(), Eigen::Index{0});
  }
  return out;
}

/// Those of the problem, not that of a curve.
Eigen::Index declared_priors(const Linearisation& linear) {
  return linear.prior_rows.rows() - linear.curve_rows;
}

Linearisation without_priors(Linearisation linear) {
  linear.prior_rows.topRows(declared_priors(linear)).setZero();
  linear.prior_residuals.head(declared_priors(linear)).setZero();
  return linear;
}

bool acts_on_slides(const Candidate& candidate, const Linearisation& linear) {
  return std::ranges::any_of(linear.observations, [&](const Observation* each) {
    return reads_slide(each) && candidate.term.acts_on(*each->profile);
  });
}

bool is_seen(const FittedModel& without, const Whitened& data, const AcceptedEffect& effect) {
  const Eigen::MatrixXd columns = stacked_columns(
      without.model, effect.candidate->term, effect.shape, without.fit.linear.prior_rows.rows());
  const double size = without.model.gates.size;
  return project(data, columns).gain >= size * size;
}

void add_rival(const std::string& rival, TraceRound& round) {
  if (std::ranges::count(round.ambiguous_with, rival) == 0) round.ambiguous_with.push_back(rival);
}

}  // namespace

void doubt_what_rests_on_others(ModelExtender& extender, Selection& selection) {
  if (selection.effects.empty()) return;
  const auto& [model, fit] = extender.extended(selection.effects);
  const std::vector<std::string> errors = errors_of_readings(model);
  const bool has_priors = declared_priors(fit.linear) > 0;
  if (errors.empty() && !has_priors) return;
  for (std::size_t i = 0; i < selection.effects.size(); ++i) {
    AcceptedEffect& effect = selection.effects[i];
    const FittedModel& without = extender.extended(all_but(selection.effects, i));
    const Linearisation& linear = without.fit.linear;
    if (!errors.empty() && !acts_on_slides(*effect.candidate, linear) &&
        !is_seen(without, {linear, fit.noise, all_of_slides(linear)}, effect)) {
      for (const std::string& each : errors) add_rival(each, effect.round);
      selection.notes.push_back(effect.name() +
                                " rests on the readings of the slide: an error of theirs would "
                                "look the same");
    }
    if (has_priors && !is_seen(without, {without_priors(linear), fit.noise}, effect)) {
      add_rival(kUnnamedRival, effect.round);
      selection.notes.push_back(effect.name() +
                                " rests on the priors: without them the data do not show it");
    }
  }
}

}  // namespace slideway
