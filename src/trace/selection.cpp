#include "selection.hpp"

#include <algorithm>
#include <set>

#include "additions.hpp"
#include "outcome.hpp"
#include "slideway/base/text.hpp"
#include "stability.hpp"
#include "structure.hpp"
#include "widening.hpp"

namespace slideway {
namespace {

using Effects = std::vector<AcceptedEffect>;

class Selector {
 public:
  Selector(const Problem& problem, SetStatistics& statistics, const Gates& gates,
           const Progress& progress)
      : problem_(problem),
        statistics_(statistics),
        extender_(statistics.extender()),
        gates_(gates),
        progress_(progress) {}

  Selection run() {
    select();
    hold_against_one_in_each();
    hold_against_causes();
    hold_against_the_unnamed();
    name_rivals();
    out_.lack_of_fit = left_over();
    out_.withheld = out_.withheld || one_stands_out() || something_is_left();
    return std::move(out_);
  }

 private:
  void select() {
    std::set<std::vector<std::string>> seen;  // sets of effects that were complete
    do {
      narrowed_ = false;
      grow();
      drop_small();
      exchange();
    } while (narrowed_ && seen.insert(names()).second);
    take_back();
    add_places();
  }

  /// Of the effects of the set, in alphabetical order.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const AcceptedEffect& effect : out_.effects) out.push_back(effect.name());
    std::ranges::sort(out);
    return out;
  }

  [[nodiscard]] LackOfFit left_over() {
    const FittedModel& fitted = extender_.extended(out_.effects);
    return lack_of_fit(fitted.fit.linear, extender_.search(out_.effects).data.noise(), gates_);
  }

  AcceptedEffect accepted(const SearchRound& round, const TestedCandidate& choice) {
    return as_accepted(round, choice, gates_, extender_.summary({}).rms_um);
  }

  void grow() {
    while (distinct_effects(out_.effects) < problem_.trace.max_effects) {
      const SearchRound& round = extender_.search(out_.effects);
      const TestedCandidate* choice = round.choice(gates_, ruled_out_);
      if (!choice) return;
      Effects more = out_.effects;
      more.push_back(accepted(round, *choice));
      std::string why = reason_against(statistics_, gates_, more, more.size() - 1);
      if (why.empty()) why = comes_and_goes(stability(round, *choice, gates_));
      if (!why.empty()) {
        ruled_out_.push_back(choice->name());
        out_.notes.push_back(choice->name() + " was refused: " + why);
        continue;
      }
      out_.effects = std::move(more);
      drop_superfluous();
      confine_last(round, *choice);
    }
  }

  /// Whether an effect of all profiles would shrink to a part of itself after it has made several
  /// such parts superfluous: none of the others can come back.
  [[nodiscard]] bool narrows_to_one_of_several(const AcceptedEffect& effect,
                                               const TestedCandidate& part) const {
    const std::string& name = effect.round.accepted;
    return effect.candidate->term.profiles.empty() &&
           part.refined.candidate->effect_name() == name &&
           std::ranges::count_if(
               ruled_out_, [&](const std::string& out) { return out.starts_with(name + "["); }) > 1;
  }

  /// An effect of all profiles beside the same effect in some of them is confined to the rest,
  /// where that explains as much.
  void confine_last(const SearchRound& round, const TestedCandidate& last) {
    const Effects others = all_but(out_.effects, out_.effects.size() - 1);
    if (!has_part_in(others, last)) return;
    for (const TestedCandidate& each : round.tested) {
      if (each.refined.candidate->effect_name() != last.refined.candidate->effect_name() ||
          each.refined.candidate->term.profiles.empty() || !each.refused(gates_).empty() ||
          std::ranges::count(ruled_out_, each.name()) > 0 ||
          each.refined.projection.gain < last.refined.projection.gain - gates_.exchange_bic)
        continue;
      out_.effects.back() = accepted(round, each);
      ruled_out_.push_back(last.name());
      return;
    }
  }

  /// Why an effect that resamples often find nothing instead of does not enter; "": it does.
  [[nodiscard]] std::string comes_and_goes(const Stability& found) const {
    if (found.share >= gates_.stable_share || found.other != kNothing) return "";
    return "only " + significant(100.0 * found.share, 2) +
           " % of the resamples choose it, the others most often nothing";
  }

  /// Whether the last search finds more than noise gives: an effect of all profiles that passes, or
  /// so much that it does not matter where and why no name was given.
  [[nodiscard]] bool something_is_left() {
    const SearchRound& round = extender_.search(out_.effects);
    const bool has_several = round.data.observations() > 1;
    return std::ranges::any_of(round.tested, [&](const TestedCandidate& each) {
      return finds_too_much(each, gates_) ||
             (has_several && each.refined.candidate->term.profiles.empty() &&
              !is_kinematic(*each.refined.candidate) && each.refused(gates_).empty() &&
              std::ranges::count(ruled_out_, each.name()) == 0);
    });
  }

  /// Earlier effects that the last one has made superfluous leave.
  void drop_superfluous() {
    for (std::size_t i = 0; i + 1 < out_.effects.size();) {
      if (statistics_.gain_beside(out_.effects, i) >= gates_.delta_bic) {
        ++i;
        continue;
      }
      ruled_out_.push_back(out_.effects[i].name());
      leave(i, out_.effects.back().name() + " has made it superfluous");
    }
  }

  void leave(std::size_t which, const std::string& why) {
    out_.left.emplace_back(out_.effects[which].name(), why);
    if (out_.effects[which].candidate->raises_degree) out_.instead.clear();
    out_.effects = all_but(std::move(out_.effects), which);
    for (AcceptedEffect& each : out_.effects) each.is_expected &= count_of_places(out_.effects) > 2;
  }

  /// Each effect once more against all candidates, the others as they are: a better one takes its
  /// place.
  void exchange() {
    for (std::size_t i = 0; i < out_.effects.size(); ++i) {
      tell("comparing rivals", i);
      const SearchRound& round = extender_.search(all_but(out_.effects, i));
      const TestedCandidate* best = round.choice(gates_, excluded_);
      if (!best) continue;
      const TestedCandidate* own = find_tested(round, out_.effects[i], gates_);
      if (own && own->refined.delta_bic <= best->refined.delta_bic + gates_.exchange_bic)
        best = own;
      if (best->refined.candidate == out_.effects[i].candidate ||
          (own && has_part_in(all_but(out_.effects, i), *best)) ||
          narrows_to_one_of_several(out_.effects[i], *best))
        continue;
      Effects changed = out_.effects;
      changed[i] = accepted(round, *best);
      if (!reason_against(statistics_, gates_, changed, i).empty()) continue;
      narrowed_ |= best->refined.candidate->effect_name() == out_.effects[i].round.accepted &&
                   best->name() != out_.effects[i].name();
      if (best->name() != out_.effects[i].name())
        out_.left.emplace_back(out_.effects[i].name(), best->name() + " fits better");
      out_.effects = std::move(changed);
    }
  }

  /// What is too small beside the others leaves before rivals are compared: a rival would take a
  /// part of theirs.
  void drop_small() {
    for (std::size_t i = out_.effects.size(); i-- > 0;) {
      const std::string why = too_small(extender_, gates_, out_.effects, i, nullptr);
      if (why.empty()) continue;
      ruled_out_.push_back(out_.effects[i].name());
      leave(i, why);
    }
  }

  /// Takes back what does not pass every gate beside the others as they are now.
  void take_back() {
    for (std::size_t i = out_.effects.size(); i-- > 0;) {
      const std::string why = reason_to_leave(i);
      if (why.empty()) continue;
      ruled_out_.push_back(out_.effects[i].name());
      taken_back_.push_back(ruled_out_.back());
      leave(i, why);
      i = out_.effects.size();  // the others once more
    }
  }

  /// Whether an effect of all profiles that was taken back passes the gates of the search, under
  /// the noise beside it, all the same: it has found something.
  bool one_stands_out() {
    const SearchRound& round = extender_.search(out_.effects);
    return std::ranges::any_of(round.tested, [&](const TestedCandidate& each) {
      return each.refined.candidate->term.profiles.empty() && each.refused(gates_).empty() &&
             std::ranges::count(taken_back_, each.name()) > 0;
    });
  }

  std::string reason_to_leave(std::size_t i) {
    const AcceptedEffect& effect = out_.effects[i];
    const SearchRound& round = extender_.search(all_but(out_.effects, i));
    if (!find_tested(round, effect, gates_)) {
      for (const TestedCandidate& each : round.tested)
        if (each.refined.candidate == effect.candidate) return each.refused(gates_);
      return "beside the others it gains too little";
    }
    std::string why = reason_against(statistics_, gates_, out_.effects, i);
    if (why.empty())
      why = worsens(extender_.summary(all_but(out_.effects, i)), extender_.summary(out_.effects));
    if (why.empty()) why = too_small(extender_, gates_, out_.effects, i, nullptr);
    if (!why.empty() || !left_over().significant(gates_)) return why;
    const FittedModel& fitted = extender_.extended(out_.effects);
    const SearchRound& last = extender_.search(out_.effects);
    const Widening unnamed =
        widening(fitted.model, fitted.fit,
                 find_structure(fitted.model, last.data, fitted.fit.linear), last.tested);
    return too_small(extender_, gates_, out_.effects, i, &unnamed);
  }

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
    Selector each(problem_, statistics_, gates_, progress_);
    for (const Candidate& candidate : extender_.dictionary().candidates)
      if (is_of_all(candidate)) each.exclude(candidate.name());
    each.select();
    // Beside one of all, that of one trace is its difference from the others, and no place.
    const bool is_difference =
        any([&](const Candidate& one) { return is_of_place(one) && !is_of_all(one); });
    leaves_to(each, is_difference ? gates_.tie_bic + statistics_.price(each.out_.effects) -
                                        statistics_.price(out_.effects)
                                  : -gates_.exchange_bic);
  }

  /// A carriage's polynomial of a higher degree comes near every sum of smooth effects, and leaves
  /// them nothing to explain once it is in the model. So effects are selected without it, too.
  void hold_against_causes() {
    Selector without(problem_, statistics_, gates_, progress_);
    for (const AcceptedEffect& effect : out_.effects)
      if (effect.candidate->raises_degree) without.exclude(effect.name());
    if (without.excluded_.empty()) return;
    without.select();
    if (without.out_.effects.empty() || leaves_to(without, -gates_.exchange_bic)) return;
    if (const TestedCandidate* more = best_that_is_possible(extender_.search(without.out_.effects),
                                                            gates_, without.excluded_))
      without.out_.effects.push_back({more->refined.candidate, more->refined.shape, {}});
    if (statistics_.lead(out_.effects, without.out_.effects) > gates_.tie_bic) return;
    std::vector<std::string> causes = without.names();
    std::erase_if(causes, [own = names()](const std::string& each) {
      return std::ranges::count(own, each) > 0;
    });
    for (AcceptedEffect& effect : out_.effects) {
      if (!effect.candidate->raises_degree) continue;
      effect.round.ambiguous_with = causes;
      out_.notes.push_back(effect.name() + ": without it, " + joined(causes, " and ") +
                           " explain as much");
    }
    out_.instead = std::move(without.out_.effects);
  }

  /// Whether this set leads another one, selected without some candidates, by so little that the
  /// other takes its place.
  bool leaves_to(Selector& other, double by) {
    if (other.out_.effects.empty() || statistics_.lead(out_.effects, other.out_.effects) >= by)
      return false;
    const std::string together = joined(other.names(), " and ");
    for (const std::string& name : names())
      if (std::ranges::count(other.excluded_, name) > 0)
        other.out_.left.emplace_back(name, together + " without it fits better");
    out_ = std::move(other.out_);
    ruled_out_ = std::move(other.ruled_out_);
    taken_back_ = std::move(other.taken_back_);
    return true;
  }

  /// The places of the other traces, where several have one of their own.
  void add_places() {
    const std::size_t before = out_.effects.size();
    while (const TestedCandidate* next =
               place_of_another(extender_.search(out_.effects), out_.effects)) {
      AcceptedEffect place = accepted(extender_.search(out_.effects), *next);
      place.is_expected = true;
      out_.effects.push_back(std::move(place));
    }
    if (out_.effects.size() > before) take_back();
  }

  /// Never to be chosen.
  void exclude(const std::string& name) {
    excluded_.push_back(name);
    ruled_out_.push_back(name);
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
      leave(weakest(found.in_place_of), found.rival +
                                            " without a name explains more: difference in BIC " +
                                            significant(-2.0 * found.margin, 2));
      out_.withheld = true;
      take_back();
    }
  }

  /// The effect of a set that gains least beside the others.
  std::size_t weakest(const std::vector<std::size_t>& among) {
    return *std::ranges::min_element(
        among, {}, [&](std::size_t i) { return statistics_.gain_beside(out_.effects, i); });
  }

  void tell(const std::string& stage, std::size_t i) const {
    if (progress_)
      progress_(stage, static_cast<double>(i) / static_cast<double>(out_.effects.size()));
  }

  const Problem& problem_;
  SetStatistics& statistics_;
  ModelExtender& extender_;
  const Gates& gates_;
  const Progress& progress_;
  std::vector<std::string> excluded_;
  std::vector<std::string> ruled_out_;   // names that do not help beside the others
  std::vector<std::string> taken_back_;  // those of them that were in the set
  bool narrowed_ = false;  // the same effect in fewer cuts: it may be in others as well
  Selection out_;
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
  return Selector(problem, statistics, gates, progress).run();
}

}  // namespace slideway
