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
  std::ranges::stable_sort(findings, {}, &Finding::delta_bic);
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

Model with(const Model& model, const AcceptedEffect& effect) {
  Model out = model;
  append_term(out, {effect.candidate->effect_name(), effect.candidate->options, {}}, out.range);
  return out;
}

/// The shapes of a model, those of an effect behind them.
Eigen::VectorXd shapes_with(const Eigen::VectorXd& shapes, const std::vector<double>& more) {
  Eigen::VectorXd out(shapes.size() + std::ssize(more));
  out << shapes, Eigen::Map<const Eigen::VectorXd>(more.data(), std::ssize(more));
  return out;
}

/// The model of all profiles with an effect as those but one show it.
FittedModel as_the_others_show(const FittedModel& all, const FittedModel& others,
                               const AcceptedEffect& effect) {
  const FittedModel shown =
      fit_model(with(others.model, effect), shapes_with(others.fit.estimate.shapes, effect.shape));
  FittedModel out(with(all.model, effect), all.fit);
  out.fit.estimate = shown.fit.estimate;
  out.fit.estimate.nuisances = all.fit.estimate.nuisances;
  out.fit.linear = linearise(out.model, out.fit.estimate);
  return out;
}

class TimeFinder {
 public:
  TimeFinder(const Problem& problem, ModelExtender& extender, const std::vector<ShownEffect>& shown)
      : problem_(with_effects_of_time(problem)),
        extender_(extender),
        shown_(shown),
        noise_(noise_beside(extender.base().fit.linear, problem.trace.gates)) {}

  /// Holds each profile out that has a clock. Heat that tilts the slide shows in each cut in
  /// another way: a wrong clock that does not explain more, by what noise of the size that it
  /// leaves gives, is none.
  void try_all() {
    const FittedModel& base = extender_.base();
    for (const Observation* const observation : fitted_observations(base.model))
      if (observation->profile->setup.cut_direction) try_profile(observation->profile->name);
    if (found_.empty()) return;
    const Whitened data(base.fit.linear, noise_);
    const double heat = data.residual().squaredNorm() -
                        2.0 * heat_lifts_and_tilts(base.model, data, base.fit.linear);
    const double least =
        std::ranges::min(found_, {}, [](const auto& each) { return each.first; }).first;
    const double noise = std::max(1.0, least / static_cast<double>(data.values()));
    if (heat - least < problem_.trace.gates.tie_bic * noise) found_.clear();
  }

  /// Those that leave the least, one of a kind in each profile. A start may be any: where one
  /// leaves the least, all that leave no more than noise are told.
  [[nodiscard]] std::vector<Blunder> best() {
    std::ranges::stable_sort(found_, {}, [](const auto& each) { return each.first; });
    std::vector<Blunder> out;
    for (const std::pair<double, Blunder>& each : found_) {
      const Blunder& blunder = each.second;
      const auto is_known = [&](const Blunder& known) {
        return known.profile == blunder.profile && known.what == blunder.what;
      };
      if (!out.empty() && out.front().what != BlunderKind::clock &&
          each.first > found_.front().first + problem_.trace.gates.tie_bic)
        break;
      if (std::ranges::none_of(out, is_known)) out.push_back(blunder);
    }
    return out;
  }

  /// The best that cost no more.
  [[nodiscard]] std::vector<Blunder> best_below(double cost) {
    std::erase_if(found_, [&](const auto& each) { return each.first > cost; });
    return best();
  }

  /// The best, unless a model of the profiles as they are costs less.
  [[nodiscard]] std::vector<Blunder> best_instead_of(const std::vector<AcceptedEffect>& effects) {
    const Whitened data(extender_.extended(effects).fit.linear, noise_);
    double cost = data.residual().squaredNorm();
    for (const AcceptedEffect& each : effects)
      cost += penalty(data, *each.candidate, each.candidate->amplitudes());
    return best_below(cost - std::log(static_cast<double>(data.values())));  // of the start
  }

 private:
  void try_profile(const std::string& odd) {
    extender_.limit().check();
    std::vector<Profile> profiles = extender_.profiles();
    std::ranges::find(profiles, odd, &Profile::name)->role = Role::holdout;
    const FittedModel others = fitted_to(problem_, profiles, shown_);
    const Dictionary dictionary =
        make_dictionary(others.model, problem_, others.fit.linear.prior_rows.rows());
    for (const AcceptedEffect& effect : shown_effects(problem_, others, dictionary))
      for (const CorrectedBlunder& each :
           find_blunders_of_time(as_the_others_show(extender_.base(), others, effect), odd))
        if (const auto left = left_by(each, effect)) found_.emplace_back(*left, each.blunder);
  }

  /// Square of the white residual of all profiles, one of them corrected, with the effect and its
  /// price; nothing where that is still more than noise.
  [[nodiscard]] std::optional<double> left_by(const CorrectedBlunder& corrected,
                                              const AcceptedEffect& effect) const {
    extender_.limit().check();
    std::vector<Profile> profiles = extender_.profiles();
    *std::ranges::find(profiles, corrected.meant.name, &Profile::name) = corrected.meant;
    const bool turned = corrected.blunder.what == BlunderKind::cut_direction;
    const FittedModel declared = fitted_to(
        problem_, profiles, turned ? of_any_phase_in(shown_, corrected.meant.name) : shown_);
    const FittedModel fitted = fit_model(with(declared.model, effect),
                                         shapes_with(declared.fit.estimate.shapes, effect.shape));
    const Gates& gates = problem_.trace.gates;
    if (lack_of_fit(fitted.fit.linear, noise_, gates).significant(gates)) return std::nullopt;
    const Whitened data(fitted.fit.linear, noise_);
    return data.residual().squaredNorm() +
           penalty(data, *effect.candidate, effect.candidate->amplitudes());
  }

  Problem problem_;
  ModelExtender& extender_;
  const std::vector<ShownEffect>& shown_;
  std::vector<Noise> noise_;
  std::vector<std::pair<double, Blunder>> found_;
};

/// The declared model of the profiles, the sign of one of them turned.
struct Turned {
  double cost = 0.0;  // square of the white residual
  bool is_noise = true;
  bool agrees = true;  // no two profiles differ by more than noise
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
  out.is_noise = !lack_of_fit(linear, noise_beside(linear, gates), gates).significant(gates);
  out.agrees = disagreement(fitted, noise_of_each(linear, fitted.fit.noise, gates)).p_value >=
               gates.disagreement_p;
  return out;
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
  return finder.best();
}

std::vector<Blunder> time_blunders_instead(const std::vector<AcceptedEffect>& effects,
                                           const Problem& problem, ModelExtender& extender,
                                           const std::vector<ShownEffect>& shown) {
  const auto of_all_in_time = [](const AcceptedEffect& each) {
    return each.candidate->term.profiles.empty() && is_of_time(*each.candidate->term.effect);
  };
  const auto may_not_be = [](const AcceptedEffect& each) { return !is_kinematic(*each.candidate); };
  if (std::ranges::none_of(effects, of_all_in_time) ||
      std::ranges::count_if(effects, may_not_be) < 2 || !can_tell(extender))
    return {};
  TimeFinder finder(problem, extender, shown);
  finder.try_all();
  return finder.best_instead_of(effects);
}

std::vector<Blunder> held_against_time(std::vector<Blunder> found, const Problem& problem,
                                       ModelExtender& extender,
                                       const std::vector<ShownEffect>& shown) {
  if (found.empty() || found.front().what != BlunderKind::sign || !can_tell(extender)) return found;
  const Gates& gates = problem.trace.gates;
  const bool is_sure = found.front().left <= gates.blunder_left * gates.blunder_left;
  const Turned turned = with_sign_turned(problem, extender, shown, found.front().profile);
  if (turned.is_noise && is_sure) return found;
  TimeFinder finder(problem, extender, shown);
  finder.try_all();
  std::vector<Blunder> of_time = turned.is_noise ? finder.best_below(turned.cost) : finder.best();
  if (of_time.empty() && (is_sure || turned.is_noise || turned.agrees)) return found;
  return of_time;
}

}  // namespace slideway
