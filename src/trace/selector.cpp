#include "selector.hpp"

#include <algorithm>
#include <set>

#include "additions.hpp"
#include "outcome.hpp"
#include "slideway/base/text.hpp"
#include "structure.hpp"
#include "widening.hpp"

namespace slideway {

void Selector::select() {
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

std::vector<std::string> Selector::names() const {
  std::vector<std::string> out;
  for (const AcceptedEffect& effect : out_.effects) out.push_back(effect.name());
  std::ranges::sort(out);
  return out;
}

LackOfFit Selector::left_over() {
  const FittedModel& fitted = extender_.extended(out_.effects);
  return lack_of_fit(fitted.fit.linear, extender_.search(out_.effects).data.noise(), gates_);
}

AcceptedEffect Selector::accepted(const SearchRound& round, const TestedCandidate& choice) {
  return as_accepted(round, choice, gates_, extender_.summary({}).rms_um);
}

void Selector::grow() {
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

bool Selector::narrows_to_one_of_several(const AcceptedEffect& effect,
                                         const TestedCandidate& part) const {
  const std::string& name = effect.round.accepted;
  return effect.candidate->term.profiles.empty() && part.refined.candidate->effect_name() == name &&
         std::ranges::count_if(
             ruled_out_, [&](const std::string& out) { return out.starts_with(name + "["); }) > 1;
}

void Selector::confine_last(const SearchRound& round, const TestedCandidate& last) {
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

std::string Selector::comes_and_goes(const Stability& found) const {
  if (found.share >= gates_.stable_share || found.other != kNothing) return "";
  return "only " + significant(100.0 * found.share, 2) +
         " % of the resamples choose it, the others most often nothing";
}

bool Selector::something_is_left() {
  const SearchRound& round = extender_.search(out_.effects);
  const bool has_several = round.data.observations() > 1;
  return std::ranges::any_of(round.tested, [&](const TestedCandidate& each) {
    return finds_too_much(each, gates_) ||
           (has_several && each.refined.candidate->term.profiles.empty() &&
            !is_kinematic(*each.refined.candidate) && each.refused(gates_).empty() &&
            std::ranges::count(ruled_out_, each.name()) == 0);
  });
}

void Selector::drop_superfluous() {
  for (std::size_t i = 0; i + 1 < out_.effects.size();) {
    if (statistics_.gain_beside(out_.effects, i) >= gates_.delta_bic) {
      ++i;
      continue;
    }
    ruled_out_.push_back(out_.effects[i].name());
    leave(i, out_.effects.back().name() + " has made it superfluous");
  }
}

void Selector::leave(std::size_t which, const std::string& why) {
  out_.left.emplace_back(out_.effects[which].name(), why);
  if (out_.effects[which].candidate->raises_degree) out_.instead.clear();
  out_.effects = all_but(std::move(out_.effects), which);
  for (AcceptedEffect& each : out_.effects) each.is_expected &= count_of_places(out_.effects) > 2;
}

void Selector::exchange() {
  for (std::size_t i = 0; i < out_.effects.size(); ++i) {
    tell("comparing rivals", i);
    const SearchRound& round = extender_.search(all_but(out_.effects, i));
    const TestedCandidate* best = round.choice(gates_, excluded_);
    if (!best) continue;
    const TestedCandidate* own = find_tested(round, out_.effects[i], gates_);
    if (own && (own->refined.delta_bic <= best->refined.delta_bic + gates_.exchange_bic ||
                (is_measured(*own->refined.candidate) &&
                 std::ranges::count(round.outranked(*own, gates_), best) > 0)))
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

void Selector::drop_small() {
  for (std::size_t i = out_.effects.size(); i-- > 0;) {
    const std::string why = too_small(extender_, gates_, out_.effects, i, nullptr);
    if (why.empty()) continue;
    ruled_out_.push_back(out_.effects[i].name());
    leave(i, why);
  }
}

void Selector::take_back() {
  for (std::size_t i = out_.effects.size(); i-- > 0;) {
    const std::string why = reason_to_leave(i);
    if (why.empty()) continue;
    ruled_out_.push_back(out_.effects[i].name());
    taken_back_.push_back(ruled_out_.back());
    leave(i, why);
    i = out_.effects.size();  // the others once more
  }
}

bool Selector::one_stands_out() {
  const SearchRound& round = extender_.search(out_.effects);
  return std::ranges::any_of(round.tested, [&](const TestedCandidate& each) {
    return each.refined.candidate->term.profiles.empty() && each.refused(gates_).empty() &&
           std::ranges::count(taken_back_, each.name()) > 0;
  });
}

std::string Selector::reason_to_leave(std::size_t i) {
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
      widening(fitted.model, fitted.fit, find_structure(fitted.model, last.data, fitted.fit.linear),
               last.tested);
  return too_small(extender_, gates_, out_.effects, i, &unnamed);
}

void Selector::grow_from(const Candidate& raised) {
  out_.effects = {{&raised, {}, {}}};
  out_.effects.front().round.accepted = raised.effect_name();
  grow();
}

void Selector::begin_with(const TestedCandidate& found) {
  out_.effects = {accepted(extender_.search({}), found)};
}

void Selector::complete(const Candidate& raised) {
  if (out_.effects.size() == 1) return out_.effects.clear();  // to choose again is to raise it more
  select();
  for (std::size_t i = 0; i < out_.effects.size(); ++i) {
    if (out_.effects[i].candidate != &raised) continue;
    const SearchRound& round = extender_.search(all_but(out_.effects, i));
    out_.effects[i] = accepted(round, *find_tested(round, out_.effects[i], gates_));
  }
}

bool Selector::leaves_to(Selector& other, double by) {
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

void Selector::add_places() {
  const std::size_t before = out_.effects.size();
  while (const TestedCandidate* next =
             place_of_another(extender_.search(out_.effects), out_.effects)) {
    AcceptedEffect place = accepted(extender_.search(out_.effects), *next);
    place.is_expected = true;
    out_.effects.push_back(std::move(place));
  }
  if (out_.effects.size() > before) take_back();
}

void Selector::exclude(const std::string& name) {
  excluded_.push_back(name);
  ruled_out_.push_back(name);
}

void Selector::tell(const std::string& stage, std::size_t i) const {
  if (progress_)
    progress_(stage, static_cast<double>(i) / static_cast<double>(out_.effects.size()));
}

}  // namespace slideway
