#include "set_gates.hpp"

#include <algorithm>
#include <cmath>

#include "fit_numbers.hpp"
#include "slideway/base/text.hpp"

namespace slideway {

std::string worsens(const ModelResult& without, const ModelResult& with) {
  double rise = 0.0;
  const auto add = [&](const std::optional<double>& before, const std::optional<double>& after) {
    if (before && after && *before > 0.0) rise += *after * *after / (*before * *before) - 1.0;
  };
  add(without.rms_um, with.rms_um);
  add(without.rms_urad, with.rms_urad);
  if (const auto before = holdout_rms_um(without); before && !(*holdout_rms_um(with) < *before))
    return "it predicts the held-out profiles worse";
  if (rise > 0.0) return "the residual rises with it";
  return "";
}

std::string reason_against(SetStatistics& statistics, const Gates& gates,
                           const std::vector<AcceptedEffect>& effects, std::size_t which) {
  ModelExtender& extender = statistics.extender();
  const std::vector<AcceptedEffect> others = all_but(effects, which);
  std::string why =
      worsens(extender.summary_of_search(others), extender.summary_of_search(effects));
  if (!why.empty() || !effects[which].candidate->term.effect->is_carriage()) return why;
  const double margin = statistics.over_process(effects, which);
  if (margin < gates.process_margin)
    why = "a smooth process without a name fits as well: difference in BIC " +
          significant(-2.0 * margin, 2);
  return why;
}

std::string too_small(ModelExtender& extender, const Gates& gates,
                      const std::vector<AcceptedEffect>& effects, std::size_t which,
                      const Widening* unnamed) {
  const FittedModel& fitted = extender.extended(effects);
  const auto term = std::ranges::find(fitted.model.terms, effects[which].name(), &ModelTerm::name);
  if (!term->effect->has_one_size() || effects[which].candidate->raises_degree ||
      effects[which].is_expected)
    return "";
  const Eigen::Index decisive = term->first_parameter + term->effect->decisive_parameter();
  const Eigen::RowVectorXd row = fitted.fit.parameters.jacobian.row(decisive);
  const double more = unnamed ? unnamed->variance(row) : 0.0;
  const double bend = widening_by_bend(fitted.fit, *term);
  double size =
      std::abs(fitted.fit.parameters.values[decisive]) /
      std::hypot(fitted.fit.uncertainty.of(row).standard_uncertainty / bend, std::sqrt(more));
  if (!(size < gates.size)) size = bend * size_in_uncertainties(extender.summary(effects), *term);
  if (!(size < gates.size)) return "";
  return "its size is only " + significant(size, 2) + " of its standard uncertainties";
}

const TestedCandidate* find_tested(const SearchRound& round, const AcceptedEffect& effect,
                                   const Gates& gates) {
  const auto is_it = [&](const TestedCandidate& each) {
    return each.name() == effect.name() && each.refined.shape.size() == effect.shape.size() &&
           (effect.is_expected || each.refused(gates).empty());
  };
  const auto found = std::ranges::find_if(round.tested, is_it);
  return found == round.tested.end() ? nullptr : &*found;
}

bool has_part_in(const std::vector<AcceptedEffect>& effects, const TestedCandidate& candidate) {
  return candidate.refined.candidate->term.profiles.empty() &&
         std::ranges::any_of(effects, [&](const AcceptedEffect& effect) {
           return effect.round.accepted == candidate.refined.candidate->effect_name();
         });
}

bool finds_too_much(const TestedCandidate& each, const Gates& gates) {
  const bool is_known =
      !each.part_of.empty() || each.of_feed_marks || is_kinematic(*each.refined.candidate);
  if (each.refined.projection.rank == 0 || is_known) return false;
  if (!each.folded.empty()) return each.delta_bic_beside() <= -gates.left_over_bic;
  return each.p_value <= gates.lack_of_fit_p && each.refined.delta_bic <= -gates.left_over_bic &&
         !(each.held_out && !each.held_out->helps);
}

const TestedCandidate* folded_wave(const SearchRound& round, const Gates& gates) {
  const auto at = std::ranges::find_if(round.tested, [&](const TestedCandidate& each) {
    return !each.folded.empty() && finds_too_much(each, gates);
  });
  return at == round.tested.end() ? nullptr : &*at;
}

}  // namespace slideway
