#include "exchange.hpp"

#include <algorithm>
#include <cmath>

#include "slideway/base/parallel.hpp"

namespace slideway {
namespace {

constexpr double kBetter = 1e-9;  // relative: less is rounding

struct RatedSet {
  CutSet set;
  double worth = -INFINITY;
};

/// The set with the cut that makes it best.
RatedSet with_one_more(const CutSet& set, std::size_t cuts,
                       const std::function<double(const CutSet&)>& worth) {
  std::vector<RatedSet> rated(cuts);
  parallel_for(cuts, [&](std::size_t c) {
    if (std::ranges::count(set, c) > 0) return;
    rated[c].set = set;
    rated[c].set.insert(std::ranges::upper_bound(rated[c].set, c), c);
    rated[c].worth = worth(rated[c].set);
  });
  const double best = std::ranges::max_element(rated, {}, &RatedSet::worth)->worth;
  return *std::ranges::find_if(rated, [&](const RatedSet& each) {  // of equal ones the first
    return each.worth >= best - kBetter * std::abs(best);
  });
}

/// The set with one of its cuts exchanged, or as it is where that brings no more.
RatedSet exchanged(const RatedSet& from, std::size_t cuts,
                   const std::function<double(const CutSet&)>& worth) {
  RatedSet best = from;
  for (std::size_t i = 0; i < from.set.size(); ++i) {
    CutSet others = from.set;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    RatedSet other = with_one_more(others, cuts, worth);
    if (other.worth > best.worth + kBetter * std::abs(best.worth)) best = std::move(other);
  }
  return best;
}

}  // namespace

std::vector<CutSet> greedy_sets(std::size_t cuts, std::size_t largest,
                                const std::function<double(const CutSet&)>& worth) {
  std::vector<CutSet> out;
  RatedSet best;
  for (std::size_t size = 1; size <= largest; ++size) {
    best = with_one_more(best.set, cuts, worth);
    for (bool better = size > 1; better;) {
      RatedSet next = exchanged(best, cuts, worth);
      better = next.set != best.set;
      best = std::move(next);
    }
    out.push_back(best.set);
  }
  return out;
}

}  // namespace slideway
