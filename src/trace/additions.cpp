#include "additions.hpp"

#include <algorithm>

#include "dictionary.hpp"

namespace slideway {
namespace {

bool is_own_place(const Candidate& candidate) { return only(candidate) && is_of_place(candidate); }

}  // namespace

const TestedCandidate* best_that_is_possible(const SearchRound& round, const Gates& gates,
                                             const std::vector<std::string>& excluded,
                                             Eigen::Index most_unknowns) {
  const auto found = std::ranges::find_if(round.tested, [&](const TestedCandidate& each) {
    return each.is_possible() && each.refined.candidate->takes.empty() &&
           each.refined.candidate->unknowns(each.refined.projection.rank) <= most_unknowns &&
           each.refined.delta_bic <= -gates.delta_bic &&
           std::ranges::count(excluded, each.name()) == 0;
  });
  return found == round.tested.end() ? nullptr : &*found;
}

int count_of_places(const std::vector<AcceptedEffect>& effects) {
  return static_cast<int>(
      std::ranges::count_if(effects, [](const auto& e) { return is_own_place(*e.candidate); }));
}

const TestedCandidate* place_of_another(const SearchRound& round,
                                        const std::vector<AcceptedEffect>& effects) {
  if (count_of_places(effects) < 2) return nullptr;
  const auto found = std::ranges::find_if(round.tested, [&](const TestedCandidate& each) {
    const Candidate& own = *each.refined.candidate;
    return is_own_place(own) && each.is_possible() && each.refined.delta_bic < 0.0 &&
           std::ranges::none_of(effects, [&](const AcceptedEffect& effect) {
             return only(*effect.candidate) == only(own) && is_own_place(*effect.candidate);
           });
  });
  return found == round.tested.end() ? nullptr : &*found;
}

}  // namespace slideway
