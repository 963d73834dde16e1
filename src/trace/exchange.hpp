#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace slideway {

using CutSet = std::vector<std::size_t>;  // rising

/// Sets of 1, 2, ... `largest` of so many cuts, by greedy exchange (Fedorov 1972): the cut that
/// brings most is added, then each of the set is exchanged as long as that brings more.
/// REQUIRES largest <= cuts
std::vector<CutSet> greedy_sets(std::size_t cuts, std::size_t largest,
                                const std::function<double(const CutSet&)>& worth);

}  // namespace slideway
