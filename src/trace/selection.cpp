#include "selection.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>

#include "additions.hpp"
#include "outcome.hpp"
#include "selector.hpp"
#include "slideway/base/text.hpp"
#include "stability.hpp"

namespace slideway {
namespace {

using Effects = Selector::Effects;

/// What is selected, held against sets that were selected otherwise and against what has no name.
class Comparison {
 public:
  Comparison(const Problem& problem, SetStatistics& statistics, const Gates& gates,
             const Progress& progress)
      : statistics_(statistics),
        extender_(statistics.extender()),
        gates_(gates),
        start_([&] { return Selector(problem, statistics, gates, progress); }),
        chosen_(start_()) {}

  Selection run() {
    chosen_.select();
    hold_against_one_in_each();
    hold_against_measured_causes();
    hold_against_causes();
    hold_against_the_unnamed();
    name_rivals();
    out_.lack_of_fit = chosen_.left_over();
    out_.withheld = out_.withheld || chosen_.one_stands_out() || chosen_.something_is_left();
    return std::move(out_);
  }

 private:
  void name_rivals() {
    for (std::size_t i = 0; i < out_.effects.size(); ++i) {
      AcceptedEffect& effect = out_.effects[i];
      const Effects others = all_but(out_.effects, i);
      const SearchRound& round = extender_.search(others);
      const TestedCandidate& own = *find_tested(round, effect, gates_);
      for (const TestedCandidate* rival : round.rivals(own, gates_))
        if (std::ranges::count(effect.round.ambiguous_with, rival->name()) == 0)
          effect.round.ambiguous_with.push_back(rival->name());
      const std::vector<std::string> outranked = outranked_by(round, own, gates_);
      out_.notes.insert(out_.notes.end(), outranked.begin(), outranked.end());
      const Stability found = stability(round, own, gates_, &extender_.extended(others));
      effect.round.stability = found.share;
      if (found.share >= gates_.stable_share || !effect.round.ambiguous_with.empty() ||
          !outranked.empty())
        continue;
      effect.round.ambiguous_with.push_back(found.other == kNothing ? kUnnamedRival : found.other);
      out_.notes.push_back(effect.name() + ": only " + significant(100.0 * found.share, 2) +
                           " % of the resamples choose it; the others most often " + found.other);
    }
  }

  /// No trace lies on the workpiece as another does. So where an effect of that is of all profiles,
  /// effects are also selected with one of its own in each.
  void hold_against_one_in_each() {
    const auto is_of_all = [](const Candidate& each) {
      return is_of_place(each) && each.term.profiles.empty();
    };
    const auto any = [&](const auto& is_such) {
      return std::ranges::any_of(out_.effects,
                                 [&](const auto& e) { return is_such(*e.candidate); });
    };
    if (!any(is_of_all)) return;
    Selector each = start_();
    for (const Candidate& candidate : extender_.dictionary().candidates)
      if (is_of_all(candidate)) each.exclude(candidate.name());
    each.select();
    // Beside one of all, that of one trace is its difference from the others, and no place.
    const bool is_difference =
        any([&](const Candidate& one) { return is_of_place(one) && !is_of_all(one); });
    chosen_.leaves_to(each, is_difference ? gates_.tie_bic + statistics_.price(each.out().effects) -
                                                statistics_.price(out_.effects)
                                          : -gates_.exchange_bic);
  }

  /// Of two measured causes each may predict left-out profiles worse than none, and one that
  /// follows late may stand for both. So effects are also selected beside the best of each that
  /// gains much and is not in the set, and beside the simplest.
  void hold_against_measured_causes() {
    for (const TestedCandidate* found : measured_causes(extender_.search({}))) {
      const auto own = std::ranges::find(out_.effects, found->name(), &AcceptedEffect::name);
      if (own != out_.effects.end() && own->shape.size() <= found->refined.shape.size()) continue;
      Selector beside = start_();
      beside.begin_with(*found);
      beside.select();
      const bool has_more = measured_in(beside.out().effects) > measured_in(out_.effects);
      chosen_.leaves_to(beside, has_more ? as_much() : -gates_.exchange_bic);
    }
  }

  static std::ptrdiff_t measured_in(const Effects& effects) {
    return std::ranges::count_if(
        effects, [](const AcceptedEffect& each) { return is_measured(*each.candidate); });
  }

  /// Within which difference of BIC another set explains as much as this one.
  double as_much() {
    return std::max(gates_.tie_bic, gates_.tie_share * statistics_.lead(out_.effects, {}));
  }

  /// Of those that are of all profiles and gain much, the best and the simplest; where there is
  /// but one, the best.
  [[nodiscard]] std::vector<const TestedCandidate*> measured_causes(
      const SearchRound& round) const {
    const auto bic_of = [](const TestedCandidate* each) { return each->refined.delta_bic; };
    std::map<std::string, std::vector<const TestedCandidate*>> found;
    for (const TestedCandidate& each : round.tested) {
      const Candidate& candidate = *each.refined.candidate;
      if (is_measured(candidate) && candidate.term.profiles.empty() &&
          each.refined.delta_bic <= -gates_.left_over_bic)
        found[each.name()].push_back(&each);
    }
    std::vector<const TestedCandidate*> out;
    for (const auto& [name, all] : found) {
      const auto* simplest = *std::ranges::min_element(
          all, {}, [](const TestedCandidate* each) { return each->refined.shape.size(); });
      out.push_back(*std::ranges::min_element(all, {}, bic_of));
      if (simplest != out.back() && has_other_log(name)) out.push_back(simplest);
    }
    std::ranges::sort(out, {}, bic_of);
    return out;
  }

  [[nodiscard]] bool has_other_log(const std::string& name) const {
    return std::ranges::any_of(extender_.dictionary().candidates, [&](const Candidate& each) {
      return is_measured(each) && each.term.profiles.empty() && each.name() != name;
    });
  }

  /// A carriage's polynomial of a higher degree comes near every sum of smooth effects, beside a
  /// lower degree too, and leaves them nothing to explain once it is in the model. So effects are
  /// selected without it, and from each lower degree on, as well.
  void hold_against_causes() {
    for (const LowerDegree& lower : lower_degrees()) {
      Selector from = start_();
      for (const std::string& name : with_shapes()) from.exclude(name);
      from.grow_from(*lower.candidate);
      const Effects beside_lower = from.out().effects;
      if (explains_as_much(beside_lower)) {
        from.complete(*lower.candidate);
        if (leaves_to(from)) continue;
      }
      hold_against(beside_lower, from.excluded(), lower.lacks,
                   "at degree " + std::to_string(*lower.candidate->options.degree));
    }
    Selector without = start_();
    for (const AcceptedEffect& effect : raised_degrees(out_.effects))
      without.exclude(effect.name());
    if (without.excluded().empty()) return;
    without.select();
    if (!without.out().effects.empty() && !leaves_to(without))
      hold_against(without.out().effects, without.excluded(),
                   std::numeric_limits<Eigen::Index>::max(), "without it");
  }

  bool explains_as_much(const Effects& others) {
    return statistics_.lead(out_.effects, others) <= gates_.tie_bic;
  }

  bool leaves_to(Selector& other) { return chosen_.leaves_to(other, -gates_.exchange_bic); }

  /// What is not in the set and has a shape: beside a lower degree it comes near a polynomial as
  /// that comes near it.
  [[nodiscard]] std::vector<std::string> with_shapes() const {
    std::vector<std::string> out;
    const std::vector<std::string> own = chosen_.names();
    for (const Candidate& each : extender_.dictionary().candidates)
      if (!each.term.effect->shapes().empty() && std::ranges::count(own, each.name()) == 0)
        out.push_back(each.name());
    return out;
  }

  struct LowerDegree {
    const Candidate* candidate;
    Eigen::Index lacks;  // amplitudes of the one that is selected
  };

  /// Those above the declared one of each polynomial that is raised further.
  [[nodiscard]] std::vector<LowerDegree> lower_degrees() const {
    std::vector<LowerDegree> out;
    for (const AcceptedEffect& effect : raised_degrees(out_.effects))
      for (const Candidate& each : extender_.dictionary().candidates) {
        const Eigen::Index lacks = effect.candidate->amplitudes() - each.amplitudes();
        if (each.raises_degree && each.name() == effect.name() && lacks > 0)
          out.push_back({&each, lacks});
      }
    return out;
  }

  /// Effects selected otherwise are rivals of a raised degree where they explain as much with the
  /// best that is possible beside them.
  void hold_against(Effects others, const std::vector<std::string>& excluded,
                    Eigen::Index most_unknowns, const std::string& how) {
    if (const TestedCandidate* more =
            best_that_is_possible(extender_.search(others), gates_, excluded, most_unknowns))
      others.push_back({more->refined.candidate, more->refined.shape, {}});
    std::vector<std::string> causes;
    const std::vector<std::string> own = chosen_.names();
    for (const AcceptedEffect& each : others)
      if (!is_kinematic(*each.candidate) && std::ranges::count(own, each.name()) == 0)
        causes.push_back(each.name());
    if (causes.empty() || !explains_as_much(others)) return;
    for (AcceptedEffect& effect : out_.effects) {
      if (!effect.candidate->raises_degree) continue;
      for (const std::string& cause : causes)
        if (std::ranges::count(effect.round.ambiguous_with, cause) == 0)
          effect.round.ambiguous_with.push_back(cause);
      out_.notes.push_back(effect.name() + ": " + how + ", " + joined(causes, " and ") +
                           (causes.size() == 1 ? " explains" : " explain") + " as much");
    }
    out_.instead.push_back(std::move(others));
  }

  /// Names what nothing without a name explains as well.
  void hold_against_the_unnamed() {
    while (!out_.effects.empty()) {
      const Standing found = statistics_.standing(out_.effects, gates_);
      if (found.margin >= 0.0) return;
      if (found.margin >= -gates_.unnamed_tie) {
        out_.unsure = found.in_place_of;
        for (const std::size_t i : found.in_place_of) {
          out_.effects[i].round.ambiguous_with.emplace_back(kUnnamedRival);
          out_.notes.push_back(out_.effects[i].name() + ": " + found.rival +
                               " explains as much, within a difference in BIC of " +
                               significant(-2.0 * found.margin, 2));
        }
        return;
      }
      chosen_.leave(weakest(found.in_place_of),
                    found.rival + " without a name explains more: difference in BIC " +
                        significant(-2.0 * found.margin, 2));
      out_.withheld = true;
      chosen_.take_back();
    }
  }

  /// The effect of a set that gains least beside the others.
  std::size_t weakest(const std::vector<std::size_t>& among) {
    return *std::ranges::min_element(
        among, {}, [&](std::size_t i) { return statistics_.gain_beside(out_.effects, i); });
  }

  SetStatistics& statistics_;
  ModelExtender& extender_;
  const Gates& gates_;
  std::function<Selector()> start_;  // another one, nothing selected yet
  Selector chosen_;
  Selection& out_ = chosen_.out();
};

}  // namespace

Selection nothing_selected(ModelExtender& extender, const Gates& gates) {
  Selection out;
  out.lack_of_fit =
      lack_of_fit(extender.base().fit.linear, extender.search({}).data.noise(), gates);
  return out;
}

Selection select_effects(const Problem& problem, SetStatistics& statistics, const Gates& gates,
                         const Progress& progress) {
  return Comparison(problem, statistics, gates, progress).run();
}

}  // namespace slideway
