#include "time_blunder.hpp"

#include <algorithm>
#include <cmath>

#include "disagreement.hpp"
#include "heat.hpp"
#include "slideway/effects/catalogue.hpp"
#include "slideway/identify/lack_of_fit.hpp"
#include "slideway/identify/noise_model.hpp"

namespace slideway {
namespace {

constexpr std::size_t kEffectsTried = 3;  // best first, each of a name of its own
constexpr std::size_t kMostHeldOut = 8;   // each takes a search

/// Whether an effect grows or fades in time; of waves each start is as good as another.
bool is_of_time(const Effect& effect) {
  const IndependentVariable variable = effect.description().variable;
  return (variable == IndependentVariable::time || variable == IndependentVariable::distance) &&
         effect.linear_parameters();
}

Problem with_effects_of_time(Problem problem) {
  std::erase_if(problem.trace.candidates,
                [](const std::string& name) { return !is_of_time(specimen(name)); });
  problem.trace.own.clear();
  return problem;
}

/// The declared model of the profiles that are not held out.
FittedModel fitted_to(const Problem& problem, const std::vector<Profile>& profiles,
                      const std::vector<ShownEffect>& shown) {
  const auto most = static_cast<std::size_t>(problem.trace.gates.search_values);
  Model model = build_model(problem, profiles, most);
  append_settled(model, shown);
  return fit_model(std::move(model));
}

/// The best effects of time that profiles show.
std::vector<AcceptedEffect> shown_effects(const Problem& problem, const FittedModel& fitted,
                                          const Dictionary& dictionary) {
  const Gates& gates = problem.trace.gates;
  Candidates candidates;
  for (const Candidate& each : dictionary.candidates)
    if (each.term.profiles.empty()) candidates.push_back(&each);
  std::vector<AcceptedEffect> out;
  if (candidates.empty()) return out;
  const Whitened data(fitted.fit.linear, noise_beside(fitted.fit.linear, gates));
  std::vector<Finding> findings = search(data, candidates);
  sort_by_priority(findings);
  for (const Finding& each : findings) {
    const auto has_name = [&](const AcceptedEffect& known) {
      return known.name() == each.candidate->name();
    };
    if (out.size() == kEffectsTried || each.delta_bic > -gates.delta_bic) break;
    if (each.rank > 0 && std::ranges::none_of(out, has_name))
      out.push_back({each.candidate, refine(fitted.model, data, each).shape, {}});
  }
  return out;
}

/// @param effect  null: none
Model with(const Model& model, const AcceptedEffect* effect) {
  Model out = model;
  if (effect)
    append_term(out, {effect->candidate->effect_name(), effect->candidate->options, {}}, out.range);
  return out;
}

/// The shapes of a model, those of an effect behind them.
Eigen::VectorXd shapes_with(const Eigen::VectorXd& shapes, const AcceptedEffect* effect) {
  if (!effect) return shapes;
  const std::vector<double>& more = effect->shape;
  Eigen::VectorXd out(shapes.size() + std::ssize(more));
  out << shapes, Eigen::Map<const Eigen::VectorXd>(more.data(), std::ssize(more));
  return out;
}

/// Whether a time constant or the like is declared: all profiles together, one of them with a wrong
/// clock, show another one than those that are right.
bool declares_shape_in_time(const Model& model) {
  return std::ranges::any_of(model.terms, [](const ModelTerm& term) {
    return is_of_time(*term.effect) && !term.effect->shapes().empty();
  });
}

/// Whether profiles hold no more than noise of what a model lacks.
bool leaves_noise(const FittedModel& fitted, const Gates& gates) {
  const Linearisation& linear = fitted.fit.linear;
  return !lack_of_fit(linear, noise_beside(linear, gates), gates).significant(gates);
}

/// Whether no two profiles differ by more than noise.
bool profiles_agree(const FittedModel& fitted, const Gates& gates) {
  const std::vector<Noise> of_each = noise_of_each(fitted.fit.linear, fitted.fit.noise, gates);
  return disagreement(fitted, of_each).p_value >= gates.disagreement_p;
}

/// The model of all profiles, with an effect or none, as those but one show it.
FittedModel as_the_others_show(const FittedModel& all, const FittedModel& others,
                               const AcceptedEffect* effect) {
  const FittedModel shown =
      fit_model(with(others.model, effect), shapes_with(others.fit.estimate.shapes, effect));
  FittedModel out(with(all.model, effect), all.fit);
  out.fit.estimate = shown.fit.estimate;
  out.fit.estimate.nuisances = all.fit.estimate.nuisances;
  out.fit.linear = linearise(out.model, out.fit.estimate);
  return out;
}

std::vector<Blunder> blunders_of(const std::vector<TimeBlunder>& found) {
  std::vector<Blunder> out;
  std::ranges::transform(found, std::back_inserter(out), &TimeBlunder::blunder);
  return out;
}

class TimeFinder {
 public:
  TimeFinder(const Problem& problem, ModelExtender& extender, const std::vector<ShownEffect>& shown)
      : problem_(with_effects_of_time(problem)),
        extender_(extender),
        shown_(shown),
        noise_(noise_beside(extender.base().fit.linear, problem.trace.gates)) {}

  /// Holds each profile out that has a clock.
  void try_all() {
    for (const Observation* const observation : fitted_observations(extender_.base().model))
      if (observation->profile->setup.cut_direction) try_profile(observation->profile->name);
  }

  /// Those that are said by themselves. A wrong clock that does not explain more than one effect of
  /// the profiles as they are, or heat that tilts the slide and so shows in each cut in another
  /// way, by what noise of the size that it leaves gives, is none; nor is one of a profile beside
  /// another one without which the rest lacks nothing, unless a declared shape in time lets any
  /// two agree.
  void keep_certain() {
    const FittedModel& base = extender_.base();
    const auto is_beside_odd = [&](const TimeBlunder& each) {
      return std::ranges::any_of(
          odd_, [&](const std::string& odd) { return odd != each.blunder.profile; });
    };
    if (!declares_shape_in_time(base.model)) std::erase_if(found_, is_beside_odd);
    if (found_.empty()) return;
    const Whitened data(base.fit.linear, noise_);
    const double square = data.residual().squaredNorm();
    double without = square - 2.0 * heat_lifts_and_tilts(base.model, data, base.fit.linear);
    for (const Finding& each : search(data, extender_.candidates_beside({})))
      if (each.rank > 0) without = std::min(without, square + each.delta_bic);
    const double least = std::ranges::min_element(found_, {}, &TimeBlunder::cost)->cost;
    const double noise = std::max(1.0, least / static_cast<double>(data.values()));
    if (without - least < problem_.trace.gates.tie_bic * noise) found_.clear();
  }

  /// Those that leave the least, one of a kind in each profile. A start may be any: where one
  /// leaves the least, all that leave no more than noise are told, unless any cut may be the wrong
  /// one.
  [[nodiscard]] std::vector<TimeBlunder> best() {
    std::ranges::stable_sort(found_, {}, &TimeBlunder::cost);
    std::vector<TimeBlunder> out;
    for (const TimeBlunder& each : found_) {
      const auto is_known = [&](const TimeBlunder& known) {
        return known.blunder.profile == each.blunder.profile &&
               known.blunder.what == each.blunder.what;
      };
      if (!out.empty() && out.front().blunder.what != BlunderKind::clock &&
          each.cost > found_.front().cost + problem_.trace.gates.tie_bic)
        break;
      if (std::ranges::none_of(out, is_known)) out.push_back(each);
    }
    if (out.size() > 1 && out.size() == tried_) out.clear();
    return out;
  }

  /// The best that cost no more.
  [[nodiscard]] std::vector<TimeBlunder> best_below(double cost) {
    std::erase_if(found_, [&](const auto& each) { return each.cost > cost; });
    return best();
  }

  /// Held against a model of the profiles as they are.
  [[nodiscard]] TimeBlundersInPlace in_place_of(const std::vector<AcceptedEffect>& effects) {
    const Whitened data(extender_.extended(effects).fit.linear, noise_);
    double cost = data.residual().squaredNorm();
    for (const AcceptedEffect& each : effects)
      cost += penalty(data, *each.candidate, each.candidate->amplitudes());
    TimeBlundersInPlace out;
    out.as_good = best_below(cost + problem_.trace.gates.tie_bic);
    keep_certain();
    out.better = blunders_of(
        best_below(cost - std::log(static_cast<double>(data.values()))));  // of the start
    return out;
  }

 private:
  void try_profile(const std::string& odd) {
    ++tried_;
    extender_.limit().check();
    std::vector<Profile> profiles = extender_.profiles();
    std::ranges::find(profiles, odd, &Profile::name)->role = Role::holdout;
    const FittedModel others = fitted_to(problem_, profiles, shown_);
    const Gates& gates = problem_.trace.gates;
    if (leaves_noise(others, gates) && profiles_agree(others, gates)) odd_.push_back(odd);
    const Dictionary dictionary =
        make_dictionary(others.model, problem_, others.fit.linear.prior_rows.rows());
    const auto try_with = [&](const AcceptedEffect* effect) {
      for (const CorrectedBlunder& each :
           find_blunders_in(as_the_others_show(extender_.base(), others, effect), odd))
        if (auto found = tested(each, effect)) found_.push_back(*std::move(found));
    };
    if (declares_shape_in_time(others.model)) try_with(nullptr);
    for (const AcceptedEffect& effect : shown_effects(problem_, others, dictionary))
      try_with(&effect);
  }

  /// Square of the white residual of all profiles, one of them corrected, with the effect and its
  /// price, if there is one; nothing where that is still more than noise.
  [[nodiscard]] std::optional<TimeBlunder> tested(const CorrectedBlunder& corrected,
                                                  const AcceptedEffect* effect) const {
    extender_.limit().check();
    std::vector<Profile> profiles = extender_.profiles();
    *std::ranges::find(profiles, corrected.meant.name, &Profile::name) = corrected.meant;
    const bool turned = corrected.blunder.what == BlunderKind::cut_direction ||
                        corrected.blunder.what == BlunderKind::sign;
    const FittedModel declared = fitted_to(
        problem_, profiles, turned ? of_any_phase_in(shown_, corrected.meant.name) : shown_);
    FittedModel fitted =
        fit_model(with(declared.model, effect), shapes_with(declared.fit.estimate.shapes, effect));
    const Gates& gates = problem_.trace.gates;
    const std::vector<Noise> noise = noise_in_unit_of(corrected, fitted.fit.linear);
    if (lack_of_fit(fitted.fit.linear, noise, gates).significant(gates) ||
        !profiles_agree(fitted, gates))
      return std::nullopt;
    const Whitened data(fitted.fit.linear, noise);
    const double price =
        effect ? penalty(data, *effect->candidate, effect->candidate->amplitudes()) : 0.0;
    const double cost = data.residual().squaredNorm() + price;
    fitted.model.observations.clear();  // they are of the profiles here
    fitted.fit.linear.observations.clear();
    return TimeBlunder{corrected.blunder, cost,
                       std::make_shared<const FittedModel>(std::move(fitted))};
  }

  /// The noise, that of the corrected profile in the unit that was meant.
  [[nodiscard]] std::vector<Noise> noise_in_unit_of(const CorrectedBlunder& corrected,
                                                    const Linearisation& linear) const {
    std::vector<Noise> out = noise_;
    for (std::size_t i = 0; i < out.size(); ++i)
      if (linear.observations[i]->profile->name == corrected.meant.name)
        out[i] = out[i].scaled(corrected.factor * corrected.factor);
    return out;
  }

  Problem problem_;
  ModelExtender& extender_;
  const std::vector<ShownEffect>& shown_;
  std::vector<Noise> noise_;
  std::vector<TimeBlunder> found_;
  std::vector<std::string> odd_;  // profiles without which the others lack nothing
  std::size_t tried_ = 0;         // profiles
};

/// The declared model of the profiles, the sign of one of them turned.
struct Turned {
  double cost = 0.0;  // square of the white residual
  bool is_noise = true;
  bool agrees = true;
};

Turned with_sign_turned(const Problem& problem, ModelExtender& extender,
                        const std::vector<ShownEffect>& shown, const std::string& which) {
  extender.limit().check();
  std::vector<Profile> profiles = extender.profiles();
  for (double& value : std::ranges::find(profiles, which, &Profile::name)->values) value = -value;
  const FittedModel fitted = fitted_to(problem, profiles, of_any_phase_in(shown, which));
  const Linearisation& linear = fitted.fit.linear;
  const Gates& gates = problem.trace.gates;
  Turned out;
  out.cost =
      Whitened(linear, noise_beside(extender.base().fit.linear, gates)).residual().squaredNorm();
  out.is_noise = leaves_noise(fitted, gates);
  out.agrees = profiles_agree(fitted, gates);
  return out;
}

bool is_of_some_in_time(const AcceptedEffect& each) {
  return is_of_time(*each.candidate->term.effect) && !each.candidate->term.profiles.empty();
}

/// Whether another profile has an effect of the same name, with a size of its own.
bool is_in_another_profile(const AcceptedEffect& effect,
                           const std::vector<AcceptedEffect>& effects) {
  return std::ranges::any_of(effects, [&](const AcceptedEffect& other) {
    return other.candidate->effect_name() == effect.candidate->effect_name() &&
           other.name() != effect.name();
  });
}

bool can_tell(const ModelExtender& extender) {
  const std::size_t fitted = fitted_observations(extender.base().model).size();
  return fitted >= 3 && fitted <= kMostHeldOut;
}

}  // namespace

std::vector<Blunder> find_time_blunders(const Problem& problem, ModelExtender& extender,
                                        const std::vector<ShownEffect>& shown) {
  if (!can_tell(extender)) return {};
  TimeFinder finder(problem, extender, shown);
  finder.try_all();
  finder.keep_certain();
  return blunders_of(finder.best());
}

TimeBlundersInPlace time_blunders_in_place(const std::vector<AcceptedEffect>& effects,
                                           const Problem& problem, ModelExtender& extender,
                                           const std::vector<ShownEffect>& shown) {
  const auto is_of_all = [&](const AcceptedEffect& each) {
    if (!is_of_time(*each.candidate->term.effect)) return false;
    return each.candidate->term.profiles.empty() || is_in_another_profile(each, effects);
  };
  const auto may_not_be = [](const AcceptedEffect& each) { return !is_kinematic(*each.candidate); };
  const bool may_be_better =
      std::ranges::any_of(effects, is_of_all) && std::ranges::count_if(effects, may_not_be) >= 2;
  const bool may_be_as_good = std::ranges::any_of(effects, is_of_some_in_time);
  if (!(may_be_better || may_be_as_good) || !can_tell(extender)) return {};
  TimeFinder finder(problem, extender, shown);
  finder.try_all();
  TimeBlundersInPlace out = finder.in_place_of(effects);
  if (!may_be_better) out.better.clear();
  if (!may_be_as_good) out.as_good.clear();
  return out;
}

void add_as_rivals(const std::vector<TimeBlunder>& blunders, Selection& selection) {
  if (blunders.empty()) return;
  for (std::size_t i = 0; i < selection.effects.size(); ++i) {
    AcceptedEffect& effect = selection.effects[i];
    if (!is_of_some_in_time(effect)) continue;
    std::vector<std::string>& rivals = effect.round.ambiguous_with;
    if (std::ranges::count(rivals, kUnnamedRival) == 0) rivals.emplace_back(kUnnamedRival);
    if (std::ranges::count(selection.unsure, i) == 0) selection.unsure.push_back(i);
  }
  std::ranges::sort(selection.unsure);
  for (const auto& [blunder, cost, fitted] : blunders) {
    selection.advice.push_back("profile " + blunder.profile + ": " +
                               std::string(text_of(blunder.what)) +
                               " would explain as much; check it");
    selection.otherwise.push_back(fitted);
  }
}

std::vector<Blunder> held_against_time(std::vector<Blunder> found, const Problem& problem,
                                       ModelExtender& extender,
                                       const std::vector<ShownEffect>& shown) {
  if (found.empty() || !can_tell(extender)) return found;
  const BlunderKind what = found.front().what;
  if (what != BlunderKind::sign) {
    const bool is_of_clock = what == BlunderKind::clock || what == BlunderKind::cut_direction;
    if (!is_of_clock || !declares_shape_in_time(extender.base().model)) return found;
    return find_time_blunders(problem, extender, shown);
  }
  const Gates& gates = problem.trace.gates;
  const bool is_sure = found.front().left <= gates.blunder_left * gates.blunder_left;
  const Turned turned = with_sign_turned(problem, extender, shown, found.front().profile);
  if (turned.is_noise && is_sure) return found;
  TimeFinder finder(problem, extender, shown);
  finder.try_all();
  finder.keep_certain();
  std::vector<Blunder> of_time =
      blunders_of(turned.is_noise ? finder.best_below(turned.cost) : finder.best());
  if (of_time.empty() && (is_sure || turned.is_noise || turned.agrees)) return found;
  return of_time;
}

}  // namespace slideway
