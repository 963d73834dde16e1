#include "blunder_rival.hpp"

#include <algorithm>

#include "blunder.hpp"
#include "slideway/identify/lack_of_fit.hpp"

namespace slideway {
namespace {

bool all_agree_beside(const TestedCandidate& effect, ModelExtender& extender) {
  const FittedModel& fitted =
      extender.extended({{effect.refined.candidate, effect.refined.shape, {}}});
  const Gates& gates = fitted.model.gates;
  return !lack_of_fit(fitted.fit.linear, fitted.fit.noise, gates).significant(gates) &&
         find_blunders(fitted).empty();
}

}  // namespace

bool explained_by_an_effect(const std::vector<Blunder>& blunders, ModelExtender& extender) {
  if (is_of_positions(blunders.front().what)) return false;
  const Gates& gates = extender.base().model.gates;
  const SearchRound& round = extender.search({});
  const double square = round.data.residual().squaredNorm();
  const auto noise = static_cast<double>(round.data.values());
  const double least = std::ranges::min(blunders, {}, &Blunder::left).left;
  const TestedCandidate* best = nullptr;
  for (const TestedCandidate& each : round.tested) {
    const Candidate& candidate = *each.refined.candidate;
    if (!candidate.term.profiles.empty() || candidate.term.effect->is_carriage() ||
        !each.refused(gates).empty())
      continue;
    const double rest = std::max(square - each.refined.projection.gain - noise, 0.0);
    if (rest < gates.blunder_rival * least * (square - noise)) return true;
    if (!best || each.refined.projection.gain > best->refined.projection.gain) best = &each;
  }
  return best && all_agree_beside(*best, extender);
}

}  // namespace slideway
