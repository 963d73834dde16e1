#include "extended_model.hpp"

#include <algorithm>
#include <set>
#include <string>

#include "kept.hpp"
#include "slideway/base/text.hpp"
#include "slideway/identify/straightness.hpp"

namespace slideway {
namespace {

/// Whether an effect of the model leaves a candidate nothing to say: it is the same effect and acts
/// in all profiles, or in one of the candidate's. In all profiles, the candidate may still be the
/// better name for what others hold; in one, it may have a freer form, or be the place of one
/// trace, which others share by chance.
bool says_the_same(const Candidate& in_model, const Candidate& candidate) {
  const std::vector<std::string>&p = in_model.term.profiles, &q = candidate.term.profiles;
  if (in_model.effect_name() != candidate.effect_name()) return false;
  if (p.empty())
    return q.empty() || (candidate.amplitudes() <= in_model.amplitudes() &&
                         !candidate.term.effect->description().of_face);
  return std::ranges::find_first_of(p, q) != p.end();
}

/// Of amplitudes and shapes, but for what a convention fixes.
Eigen::Index unknowns_of(const Candidate& candidate) {
  return candidate.unknowns(
      candidate.amplitudes() -
      std::ranges::count(candidate.term.effect->parameters(), true, &Parameter::by_convention));
}

bool is_along_slide(const Candidate& candidate) {
  return candidate.term.effect->description().variable == IndependentVariable::slide;
}

Model with(Model model, const std::vector<AcceptedEffect>& effects) {
  for (const AcceptedEffect& effect : effects)
    if (effect.candidate->raises_degree)
      remake_term(model, effect.name(), effect.candidate->options);
    else
      append_term(model, {effect.candidate->effect_name(), effect.candidate->options, {}},
                  model.range);
  return model;
}

}  // namespace

int distinct_effects(const std::vector<AcceptedEffect>& effects) {
  std::set<std::string> names;
  for (const AcceptedEffect& effect : effects) names.insert(effect.round.accepted);
  return static_cast<int>(names.size());
}

std::vector<AcceptedEffect> raised_degrees(std::vector<AcceptedEffect> effects) {
  std::erase_if(effects, [](const auto& each) { return !each.candidate->raises_degree; });
  return effects;
}

std::vector<AcceptedEffect> all_but(std::vector<AcceptedEffect> effects, std::size_t i) {
  effects.erase(std::next(effects.begin(), static_cast<std::ptrdiff_t>(i)));
  return effects;
}

std::vector<AcceptedEffect> all_but(const std::vector<AcceptedEffect>& effects,
                                    const std::vector<std::size_t>& which) {
  std::vector<AcceptedEffect> out;
  for (std::size_t i = 0; i < effects.size(); ++i)
    if (!std::ranges::binary_search(which, i)) out.push_back(effects[i]);
  return out;
}

ModelExtender::ModelExtender(const Problem& problem, const std::vector<Profile>& profiles,
                             const FittedModel& declared, const TimeLimit& limit,
                             const Progress& progress)
    : profiles_(profiles),
      declared_(declared),
      limit_(limit),
      progress_(progress),
      coarser_(search_band(problem, profiles, declared)),
      spare_values_(spare_values(base().model)),
      spare_stations_(spare_stations(base().model)) {
  if (progress_) progress_("making the columns of every candidate", 0.0);
  dictionary_ =
      make_dictionary(base().model, problem, base().fit.linear.prior_rows.rows(),
                      coarser_ ? std::vector<FastLine>{} : fast_lines(base().model, base().fit));
}

ModelExtender::Key ModelExtender::key_of(const std::vector<AcceptedEffect>& effects) {
  Key key;
  for (const AcceptedEffect& effect : effects)
    key.emplace_back(
        effect.name() + (effect.candidate->is_fast
                             ? significant(effect.candidate->grid.points()[0][0], 12)
                             : ""),
        effect.candidate->options.degree.value_or(effect.candidate->term.effect->amplitudes() +
                                                  static_cast<int>(effect.shape.size())));
  std::ranges::sort(key);
  return key;
}

const FittedModel& ModelExtender::extended(const std::vector<AcceptedEffect>& effects) {
  if (effects.empty()) return base();
  return kept_or_made(models_, key_of(effects), [&] {
    limit_.check();
    return fit_model(with(base().model, effects), shapes_of(effects));
  });
}

const ModelResult& ModelExtender::summary(const std::vector<AcceptedEffect>& effects) {
  if (!coarser_) return summary_of_search(effects);
  return kept_or_made(summaries_, key_of(effects), [&] {
    if (effects.empty()) return summarise(declared_.model, declared_.fit);
    limit_.check();
    last_fine_.emplace(key_of(effects), in_declared_band(effects));
    return summarise(last_fine_->second.model, last_fine_->second.fit);
  });
}

const ModelResult& ModelExtender::summary_of_search(const std::vector<AcceptedEffect>& effects) {
  return kept_or_made(search_summaries_, key_of(effects), [&] {
    const FittedModel& fitted = extended(effects);
    return summarise(fitted.model, fitted.fit);
  });
}

const SearchRound& ModelExtender::search(const std::vector<AcceptedEffect>& effects) {
  return kept_or_made(rounds_, key_of(effects), [&] {
    limit_.check();
    const std::string stage = "searching round " + std::to_string(effects.size() + 1);
    if (progress_) progress_(stage, 0.0);
    const FittedModel& fitted = extended(effects);
    const auto tell = [&](double done) {
      limit_.check();
      if (progress_) progress_(done < 1.0 ? "bootstrap" : stage, done < 1.0 ? done : 0.0);
    };
    return search_round(fitted.model, fitted.fit, candidates_beside(effects), calibration_, tell);
  });
}

const SearchRound* ModelExtender::searched(const std::vector<AcceptedEffect>& effects) const {
  const auto found = rounds_.find(key_of(effects));
  return found == rounds_.end() ? nullptr : &found->second;
}

FittedModel ModelExtender::take_in_declared_band(const std::vector<AcceptedEffect>& effects) {
  if (last_fine_ && last_fine_->first == key_of(effects)) return std::move(last_fine_->second);
  if (coarser_ || effects.empty()) return in_declared_band(effects);
  extended(effects);
  return std::move(models_.extract(key_of(effects)).mapped());
}

FittedModel ModelExtender::in_declared_band(const std::vector<AcceptedEffect>& effects) {
  return fit_model(with(declared_.model, effects), extended(effects).fit.estimate.shapes);
}

Searched ModelExtender::take_searched(const std::vector<AcceptedEffect>& effects) {
  if (coarser_ && !effects.empty()) {
    extended(effects);
    coarser_->fitted = std::move(models_.extract(key_of(effects)).mapped());
  }
  std::set<std::string> added;  // the effects point into what is erased from
  for (const AcceptedEffect& effect : effects) added.insert(effect.name());
  std::erase_if(dictionary_.candidates, [&](const Candidate& each) {
    return each.is_fast || (!each.raises_degree && added.contains(each.name()));
  });
  return {std::move(coarser_), std::move(dictionary_)};
}

Candidates ModelExtender::candidates_beside(const std::vector<AcceptedEffect>& effects) const {
  Eigen::Index values = spare_values_;
  std::optional<Eigen::Index> stations = spare_stations_;
  for (const AcceptedEffect& each : effects) {
    values -= unknowns_of(*each.candidate);
    if (stations && is_along_slide(*each.candidate)) *stations -= unknowns_of(*each.candidate);
  }
  const auto has_room = [&](const Candidate& candidate) {
    const Eigen::Index unknowns = unknowns_of(candidate);
    return unknowns < values && (!stations || !is_along_slide(candidate) || unknowns < *stations);
  };
  Candidates out;
  for (const Candidate& candidate : dictionary_.candidates)
    if (candidate.is_searched && has_room(candidate) &&
        std::ranges::none_of(effects, [&](const AcceptedEffect& effect) {
          return says_the_same(*effect.candidate, candidate);
        }))
      out.push_back(&candidate);
  return out;
}

Eigen::VectorXd ModelExtender::shapes_of(const std::vector<AcceptedEffect>& effects) const {
  std::vector<double> all;
  const auto append = [&](std::span<const double> shape) {
    all.insert(all.end(), shape.begin(), shape.end());
  };
  for (const ModelTerm& term : base().model.terms) {
    const auto raised = std::ranges::find_if(effects, [&](const AcceptedEffect& effect) {
      return effect.candidate->raises_degree && effect.name() == term.name;
    });
    if (raised != effects.end())
      append(raised->shape);
    else
      append(slideway::shapes_of(term, base().fit.estimate.shapes));
  }
  for (const AcceptedEffect& effect : effects)
    if (!effect.candidate->raises_degree) append(effect.shape);
  return Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all));
}

}  // namespace slideway
